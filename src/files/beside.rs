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

#[cfg(test)]
mod tests {
    use super::*;

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
