//! Tracks of markers in the pictures, `camera,frame,marker,u,v`, and the pairs they make with the markers' places in a
//! C3D file: a wand waved through the volume.

use anyhow::{Context, Result, ensure};
use glam::DVec2;

use super::pairs::{CameraPairs, Pair, add, camera_name, pixel};
use super::table::each_row;
use crate::files::{nearest, shortened};
use crate::motion::{PointTrajectory, whole};

/// A marker in one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackedPoint {
    /// The camera's name.
    pub camera: String,
    /// The frame, from 0.
    pub frame: usize,
    /// The marker's name.
    pub marker: String,
    /// Pixels, origin in the centre of the top-left one.
    pub pixel: DVec2,
}

/// Reads the text of a table of tracks; `name` stands for the file in messages. Rows with neither `u` nor `v` are left
/// out.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected; also when there is nothing in it.
pub fn parse_tracks(text: &str, name: &str) -> Result<Vec<TrackedPoint>> {
    let mut points = Vec::new();
    each_row(text, name, &["camera", "frame", "marker", "u", "v"], &[], |row| {
        let camera = camera_name(row, 0)?.to_string();
        let frame = whole(row.text(1)).with_context(|| format!("{}: column frame", row.place))?;
        let marker = row.text(2).to_string();
        ensure!(!marker.is_empty(), "{}: column marker: found ``, expected the name of a marker", row.place);
        if let Some(pixel) = pixel(row, [3, 4])? {
            points.push(TrackedPoint { camera, frame, marker, pixel });
        }
        Ok(())
    })?;
    ensure!(!points.is_empty(), "{name} holds no point, expected a row for every marker that a camera sees in a frame");
    Ok(points)
}

/// The pairs of tracks and the markers' trajectories (mm). Markers that are missing in a frame are left out.
///
/// # Errors
/// When the trajectories have no marker of a tracked name, or no tracked point has a place in the world.
pub fn join_tracks(tracks: &[TrackedPoint], markers: &PointTrajectory) -> Result<Vec<CameraPairs>> {
    let mut cameras = Vec::new();
    for tracked in tracks {
        let Some(column) = markers.column(&tracked.marker) else {
            let nearest = nearest(&tracked.marker, markers.names.iter().map(String::as_str));
            let nearest = nearest.map(|name| format!(", the nearest is `{}`", shortened(name))).unwrap_or_default();
            anyhow::bail!("there is no marker `{}`{nearest}", shortened(&tracked.marker));
        };
        let row = tracked.frame.checked_sub(markers.first_frame).and_then(|row| markers.frames.get(row));
        let Some(point) = row.and_then(|row| row[column]) else { continue };
        let name = format!("{} in frame {}", shortened(&tracked.marker), tracked.frame);
        add(&mut cameras, &tracked.camera, Pair { name, point, pixel: tracked.pixel });
    }
    let last = markers.first_frame + markers.frames.len().saturating_sub(1);
    ensure!(
        !cameras.is_empty(),
        "no tracked marker has a place in the same frame, which the markers have from {} to {last}",
        markers.first_frame
    );
    Ok(cameras)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const TRACKS: &str = "camera,frame,marker,u,v\na,3,W1,10,20\na,3,W2,11,21\nb,4,W1,12,22\nb,4,W2,,\nb,9,W1,1,1\n";

    fn markers() -> PointTrajectory {
        PointTrajectory {
            names: vec!["W1".into(), "W2".into()],
            rate: 50.0,
            first_frame: 3,
            frames: vec![vec![Some(DVec3::X), None], vec![Some(DVec3::Y), Some(DVec3::Z)]],
            smoothed: None,
        }
    }

    #[test]
    fn markers_meet_their_tracks() {
        let cameras = join_tracks(&parse_tracks(TRACKS, "t.csv").unwrap(), &markers()).unwrap();
        // W2 is missing in the world in frame 3 and in the picture in frame 4; there is no frame 9.
        assert_eq!(cameras.len(), 2);
        let only = |at: usize| (cameras[at].pairs.len(), cameras[at].pairs[0].clone());
        assert_eq!(only(0), (1, Pair { name: "W1 in frame 3".into(), point: DVec3::X, pixel: DVec2::new(10.0, 20.0) }));
        assert_eq!(only(1), (1, Pair { name: "W1 in frame 4".into(), point: DVec3::Y, pixel: DVec2::new(12.0, 22.0) }));
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let cases = [
            ("camera,frame,marker,u,v\n".to_string(), "holds no point"),
            (TRACKS.replace("a,3,W1", "a,3.5,W1"), "line 2: column frame: found `3.5`"),
            (TRACKS.replace("a,3,W1", "a,3,"), "column marker: found ``"),
            (TRACKS.replace("11,21", "11,up"), "line 3: column v: found `up`"),
        ];
        for (text, expected) in cases {
            let message = format!("{:#}", parse_tracks(&text, "t.csv").unwrap_err());
            assert!(message.contains(expected) && message.starts_with("t.csv"), "{message}\nshould say: {expected}");
        }
        let joined =
            |text: &str| join_tracks(&parse_tracks(text, "t.csv").unwrap(), &markers()).unwrap_err().to_string();
        assert!(joined(&TRACKS.replace("W2", "Wx2")).contains("no marker `Wx2`, the nearest is `W2`"));
        assert!(joined("camera,frame,marker,u,v\na,7,W1,1,2\n").contains("which the markers have from 3 to 4"));
    }
}
