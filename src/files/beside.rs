//! A file named from a folder, as people would write it.

use std::path::{Component, Path, PathBuf};

/// A file as `folder` names it, without ways into a folder and out again: `walk` and `../cam2.mp4` are `cam2.mp4`. What leads through links
/// is left as it is, since the way out may lead elsewhere.
pub(crate) fn beside(folder: &Path, file: &Path) -> PathBuf {
    let (mut folder, mut rest) = (folder.to_path_buf(), file.components());
    loop {
        let mut ahead = rest.clone();
        let is_plain = matches!(folder.components().next_back(), Some(Component::Normal(_)));
        let leaves = matches!(ahead.next(), Some(Component::ParentDir));
        if !(leaves && is_plain && folder.symlink_metadata().is_ok_and(|what| what.is_dir())) {
            return folder.join(rest.as_path());
        }
        folder.pop();
        rest = ahead;
    }
}

/// A file as `folder` names it, so that both may be moved together: up at most `up` folders and down again, in full where that does not lead
/// there or leads over the root alone. Both are absolute and without links.
pub(crate) fn seen_from(folder: &Path, file: &Path, up: usize) -> PathBuf {
    let common = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let ways_up = folder.components().count() - common;
    if common <= 1 || ways_up > up {
        return file.to_path_buf();
    }
    let down = file.components().skip(common);
    std::iter::repeat_n(Component::ParentDir, ways_up).chain(down).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_so_that_they_may_be_moved_with_their_folder() {
        let own = Path::new("/data/session/anna/walk/pantin");
        for (file, up, expected) in [
            ("/data/session/anna/walk/videos/cam1.mp4", 3, "../videos/cam1.mp4"),
            ("/data/session/anna/walk/pantin/a_%04d.png", 3, "a_%04d.png"),
            ("/data/session/calibration/c.toml", 3, "../../../calibration/c.toml"),
            ("/data/plates/cam1.png", 3, "/data/plates/cam1.png"),
            ("/data/plates/cam1.png", usize::MAX, "../../../../plates/cam1.png"),
            ("/etc/c.toml", usize::MAX, "/etc/c.toml"),
        ] {
            assert_eq!(seen_from(own, Path::new(file), up), Path::new(expected));
        }
    }

    #[test]
    fn no_way_leads_in_and_out_again() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(at("a/walk")).unwrap();
        assert_eq!(beside(&at("a/walk"), Path::new("../cam2.mp4")), at("a/cam2.mp4"));
        assert_eq!(beside(&at("a/walk"), Path::new("../../v/cam2.mp4")), at("v/cam2.mp4"));
        assert_eq!(beside(&at("a/walk"), Path::new("v/../cam2.mp4")), at("a/walk/v/../cam2.mp4"));
        assert_eq!(beside(&at("a/none"), Path::new("../cam2.mp4")), at("a/none/../cam2.mp4"));
        assert_eq!(beside(&at("a"), &at("b.png")), at("b.png"));
        assert_eq!(beside(Path::new(""), Path::new("../b.png")), Path::new("../b.png"));
        assert_eq!(beside(Path::new(".."), Path::new("../b.png")), Path::new("../../b.png"));
        assert_eq!(beside(Path::new("src"), Path::new("../b.png")), Path::new("b.png"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(at("a/walk"), at("linked")).unwrap();
            assert_eq!(beside(&at("linked"), Path::new("../b.png")), at("linked/../b.png"));
        }
    }
}
