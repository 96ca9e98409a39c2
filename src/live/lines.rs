//! A pose as a line of JSON.

use anyhow::{Context, Result};
use glam::DVec3;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::pose::LivePose;
use crate::body::{Body, DofAxis};

/// Writes the poses of a body as lines.
pub(crate) struct Lines {
    dofs: Vec<(String, DofAxis)>,
    joints: Vec<String>,
}

/// Named values in their order.
struct Named<'a, T, F>(&'a [T], &'a dyn Fn(usize) -> &'a str, F);

impl<T, V: Serialize, F: Fn(usize, &T) -> V> Serialize for Named<'_, T, F> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(values, name, written) = self;
        let mut map = serializer.serialize_map(Some(values.len()))?;
        for (at, value) in values.iter().enumerate() {
            map.serialize_entry(name(at), &written(at, value))?;
        }
        map.end()
    }
}

impl Lines {
    pub(crate) fn new(body: &Body) -> Self {
        let dofs = body.dof_names().into_iter().zip(body.dofs().map(|(_, dof)| dof.axis));
        Self { dofs: dofs.collect(), joints: body.joint_names() }
    }

    /// A line with its end. Lengths have three digits and angles six: no camera tells more, and lines stay short.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn line(&self, pose: &LivePose) -> Result<String> {
        let dof = |at: usize| self.dofs[at].0.as_str();
        let joint = |at: usize| self.joints[at].as_str();
        let in_file = |at: usize, value: &f64| rounded(self.dofs[at].1.to_file(*value), 6);
        let point = |_: usize, at: &DVec3| at.to_array().map(|value| rounded(value, 3));
        let mut text = Vec::with_capacity(4096);
        let mut serializer = serde_json::Serializer::new(&mut text);
        let cannot = || format!("frame {} cannot be written as a line of JSON", pose.frame);
        let mut map = serializer.serialize_map(None).with_context(cannot)?;
        let mut entries = || -> serde_json::Result<()> {
            map.serialize_entry("frame", &pose.frame)?;
            map.serialize_entry("time", &rounded(pose.time, 9))?;
            map.serialize_entry("latency", &rounded(pose.latency.as_secs_f64() * 1e3, 3))?;
            map.serialize_entry("fitness", &rounded(pose.fitness, 6))?;
            map.serialize_entry("confidence", &rounded(pose.confidence, 6))?;
            map.serialize_entry("wrong", &rounded(pose.wrong, 6))?;
            map.serialize_entry("lost", &pose.is_lost)?;
            map.serialize_entry("pose", &Named(&pose.pose, &dof, in_file))?;
            map.serialize_entry("joints", &Named(&pose.joints, &joint, point))?;
            map.serialize_entry("sigma", &Named(&pose.sigmas, &joint, |_, sigma: &f64| rounded(*sigma, 3)))
        };
        entries().with_context(cannot)?;
        SerializeMap::end(map).with_context(cannot)?;
        text.push(b'\n');
        String::from_utf8(text).with_context(cannot)
    }
}

/// To so many digits behind the point.
fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::live::pose::tests::posed;

    #[test]
    fn a_line_says_all_of_a_pose() {
        let body = Body::adult(1750.0).unwrap();
        let mut pose = body.standing_pose();
        pose[body.dof_index("left_elbow.ry").unwrap()] = -0.5;
        let live = LivePose { wrong: f64::NAN, is_lost: true, ..posed(&body, 7, pose) };
        let line = Lines::new(&body).line(&live).unwrap();
        assert!(line.ends_with("}\n") && line.lines().count() == 1 && line.len() < 4096, "{line}");
        let read: serde_json::Value = serde_json::from_str(&line).unwrap();
        assert_eq!((&read["frame"], &read["time"], &read["latency"]), (&7.into(), &0.28.into(), &12.345.into()));
        assert_eq!((&read["lost"], &read["confidence"]), (&true.into(), &0.5.into()));
        assert!(read["wrong"].is_null(), "JSON has no word for what is no number");
        assert_eq!(read["pose"].as_object().unwrap().len(), body.dof_count());
        assert!((read["pose"]["left_elbow.ry"].as_f64().unwrap() + 0.5f64.to_degrees()).abs() < 1e-6, "{line}");
        assert_eq!(read["joints"].as_object().unwrap().len(), body.joint_names().len());
        assert!((read["joints"]["pelvis"][2].as_f64().unwrap() - live.joints[0].z).abs() < 1e-3, "{line}");
        assert_eq!(read["sigma"]["head_top"], 12.346);
        // In the order of the tables.
        let at = |name: &str| line.find(name).unwrap();
        assert!(at("\"pelvis.tx\"") < at("\"pelvis.rz\"") && at("\"pelvis.rz\"") < at("\"left_elbow.ry\""), "{line}");
    }
}
