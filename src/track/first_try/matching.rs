//! Which camera a video is of, by its name.

use std::path::Path;

use anyhow::{Result, bail};

use super::super::filmed_plate::holds;
use crate::files::listed;
use crate::geometry::Camera;

/// The camera of each video, as an index: the one that its file is called after, or whose name its own contains; where that says
/// nothing, by the name of its folder.
///
/// # Errors
/// One sentence with all videos and all cameras, when a video is of none of them or of several, or two are of one.
pub(super) fn match_cameras(videos: &[impl AsRef<Path>], cameras: &[Camera]) -> Result<Vec<usize>> {
    let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
    let mut matched: Vec<usize> = Vec::new();
    for video in videos {
        let video = video.as_ref();
        let file = video.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
        let folder = video.parent().and_then(Path::file_name);
        let folder = folder.map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
        let why = match (by_name(&file, &names), by_name(&folder, &names)) {
            (Named::One(at), _) | (Named::None, Named::One(at)) if !matched.contains(&at) => {
                matched.push(at);
                continue;
            }
            (Named::One(at), _) | (Named::None, Named::One(at)) => format!("is the second of camera {:?}", names[at]),
            (Named::Several, _) | (_, Named::Several) => "could be of several cameras".to_string(),
            _ => "is of no camera by its name".to_string(),
        };
        // Their ends: what tells them apart, and long paths are cut.
        let videos = videos.iter().map(|video| match video.as_ref() {
            video if video.components().count() <= 2 => video.display().to_string(),
            video => {
                let [folder, file] = [video.parent().and_then(Path::file_name), video.file_name()];
                format!("…/{}", Path::new(folder.unwrap_or_default()).join(file.unwrap_or_default()).display())
            }
        });
        bail!(
            "{} {why}: the videos are {}, the cameras {}, expected videos that are called after their cameras",
            video.display(),
            listed(videos),
            listed(names)
        );
    }
    Ok(matched)
}

/// Which camera a name is of.
enum Named {
    None,
    One(usize),
    Several,
}

/// The camera of this very name, or the one with the longest name that it contains.
fn by_name(name: &str, cameras: &[&str]) -> Named {
    let lower: Vec<String> = cameras.iter().map(|camera| camera.to_lowercase()).collect();
    if let Some(at) = lower.iter().position(|camera| camera == name) {
        return Named::One(at);
    }
    let contained = || lower.iter().enumerate().filter(|(_, camera)| !camera.is_empty() && holds(name, camera));
    let Some(longest) = contained().map(|(_, camera)| camera.len()).max() else { return Named::None };
    let mut of_them = contained().filter(|(_, camera)| camera.len() == longest);
    match (of_them.next(), of_them.next()) {
        (Some((at, _)), None) => Named::One(at),
        _ => Named::Several,
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fit_tests::cameras_around;
    use super::*;

    fn cameras(names: &[&str]) -> Vec<Camera> {
        let one = cameras_around().remove(0);
        names.iter().map(|name| Camera { name: (*name).to_string(), ..one.clone() }).collect()
    }

    #[test]
    fn videos_go_to_the_cameras_they_are_called_after() {
        let of = |videos: &[&str], names: &[&str]| match_cameras(videos, &cameras(names)).unwrap();
        assert_eq!(of(&["v/cam2.mp4", "v/cam1.mp4"], &["cam1", "cam2"]), [1, 0]);
        assert_eq!(of(&["walk_CAM10_a.mov", "walk_cam1_a.mov"], &["cam1", "cam10"]), [1, 0]);
        assert_eq!(of(&["int_1/video.mp4", "int_2/video.mp4"], &["int_1", "int_2", "int_3"]), [0, 1]);
        assert_eq!(of(&["left_%04d.png", "right_%04d.png"], &["right", "left"]), [1, 0]);
    }

    #[test]
    fn what_cannot_be_matched_is_one_sentence_with_both_lists() {
        let error = |videos: &[&str], names: &[&str]| match_cameras(videos, &cameras(names)).unwrap_err().to_string();
        let none = error(&["v/cam1.mp4", "v/GX0042.mp4"], &["cam1", "cam2"]);
        assert!(none.contains("v/GX0042.mp4 is of no camera by its name"), "{none}");
        assert!(none.contains("the videos are v/cam1.mp4, v/GX0042.mp4, the cameras cam1, cam2"), "{none}");
        let twice = error(&["a_cam1.mp4", "b_cam1.mp4"], &["cam1", "cam2"]);
        assert!(twice.contains("b_cam1.mp4 is the second of camera \"cam1\""), "{twice}");
        let both = error(&["cam1_cam2.mp4"], &["cam1", "cam2"]);
        assert!(both.contains("could be of several cameras"), "{both}");
    }
}
