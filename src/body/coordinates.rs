//! A body's degrees of freedom as the coordinates of an OpenSim model: what they are called there, and in which direction they count.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use super::{Body, DofAxis, PoseTable};
use crate::files::{expected, parse_toml, read_toml, shortened};
use crate::motion::CoordinateTable;

/// The default body's coordinates.
const KNOWN: &str = include_str!("coordinates.toml");

/// A mapping file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MappingFile {
    coordinate: BTreeMap<String, Coordinate>,
}

/// What a degree of freedom is as a coordinate: `factor` times its value (degrees, metres) plus `offset`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Coordinate {
    name: String,
    #[serde(default = "one")]
    factor: f64,
    #[serde(default)]
    offset: f64,
}

fn one() -> f64 {
    1.0
}

/// The coordinates of a body, one a degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// In state-vector order, with the name of the degree of freedom.
    entries: Vec<(String, Coordinate)>,
}

impl Coordinates {
    /// The usual ones: those of OpenSim's full-body model for the degrees of freedom of the default body, and for others their own names
    /// with `_` for the dot.
    ///
    /// # Errors
    /// When a bone of another body is called so that its degree of freedom gets the name of one of these.
    pub fn of_body(body: &Body) -> Result<Self> {
        let known: MappingFile = parse_toml(KNOWN, "the coordinates of the default body")?;
        let mut entries: Vec<(String, Coordinate)> = Vec::new();
        for dof in body.dof_names() {
            let coordinate = known.coordinate.get(&dof).cloned().unwrap_or_else(|| {
                let is_blank = |c: char| c == '.' || c.is_whitespace() || c.is_control();
                let mut name = dof.replace(is_blank, "_");
                while entries.iter().any(|(_, taken)| taken.name == name) {
                    name.push('_');
                }
                Coordinate { name, factor: 1.0, offset: 0.0 }
            });
            entries.push((dof, coordinate));
        }
        let coordinates = Self { entries };
        coordinates.check()?;
        Ok(coordinates)
    }

    /// The usual ones, but for those that a mapping file has.
    ///
    /// # Errors
    /// One sentence with the file: what is wrong with its text, a degree of freedom that the body has not, a name twice.
    pub fn read(path: &Path, body: &Body) -> Result<Self> {
        Self::with(read_toml(path)?, body).with_context(|| path.display().to_string())
    }

    fn with(file: MappingFile, body: &Body) -> Result<Self> {
        let mut coordinates = Self::of_body(body)?;
        let names = body.dof_names();
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        for (dof, coordinate) in file.coordinate {
            let Some(place) = body.dof_index(&dof) else {
                anyhow::bail!(
                    "it names `{}`, which is no degree of freedom, {}",
                    shortened(&dof),
                    expected(&dof, &known)
                );
            };
            coordinates.entries[place].1 = coordinate;
        }
        coordinates.check()?;
        Ok(coordinates)
    }

    fn check(&self) -> Result<()> {
        for (index, (dof, Coordinate { name, factor, offset })) in self.entries.iter().enumerate() {
            let is_plain = !name.is_empty() && !name.chars().any(|c| c.is_whitespace() || c.is_control());
            ensure!(is_plain, "the coordinate of `{dof}` is named {name:?}, expected a name without blanks");
            ensure!(
                factor.is_finite() && *factor != 0.0 && offset.is_finite(),
                "the coordinate of `{dof}` has the factor {factor} and the offset {offset}, expected numbers, the factor not 0"
            );
            if let Some((other, _)) = self.entries[..index].iter().find(|(_, other)| other.name == *name) {
                anyhow::bail!("`{other}` and `{dof}` both are the coordinate `{name}`, expected each once");
            }
        }
        Ok(())
    }

    /// The mapping file that says all of them.
    pub fn to_toml(&self) -> String {
        let mut text = String::from(
            "# What motion.mot calls each degree of freedom: coordinate = factor x value + offset, in degrees and metres.\n\n[coordinate]\n",
        );
        for (dof, Coordinate { name, factor, offset }) in &self.entries {
            // Names of both are checked to be printable, and quotes are escaped as in any string of Rust.
            let _ = write!(text, "{dof:?} = {{ name = {name:?}");
            if *factor != 1.0 {
                let _ = write!(text, ", factor = {factor:?}");
            }
            if *offset != 0.0 {
                let _ = write!(text, ", offset = {offset:?}");
            }
            text += " }\n";
        }
        text
    }

    /// The coordinates over the frames of a table of poses, at the times that joints.csv has: degrees, metres.
    ///
    /// # Errors
    /// When the rate is not positive, or a pose does not fit the body.
    pub fn of_poses(&self, body: &Body, poses: &PoseTable, rate: f64) -> Result<CoordinateTable> {
        let row = |(frame, pose): (&usize, &Vec<f64>)| {
            body.check_pose(pose).with_context(|| format!("the pose of frame {frame}"))?;
            let values = body.dofs().zip(pose).zip(&self.entries);
            Ok(values
                .map(|(((bone, dof), value), (_, coordinate))| {
                    let bone = &body.bones[bone];
                    // The root's translation is where it is: from the world's origin.
                    let from = if bone.parent.is_some() {
                        0.0
                    } else {
                        match dof.axis {
                            DofAxis::Tx => bone.offset.x,
                            DofAxis::Ty => bone.offset.y,
                            DofAxis::Tz => bone.offset.z,
                            _ => 0.0,
                        }
                    };
                    coordinate.factor * in_opensim(dof.axis, from + value) + coordinate.offset
                })
                .collect())
        };
        self.table(&poses.frames, rate, poses.frames.iter().zip(&poses.poses).map(row).collect::<Result<_>>()?)
    }

    /// Standard deviations of the coordinates, from those of the degrees of freedom (mm, radians), a row a frame.
    ///
    /// # Errors
    /// As [`Self::of_poses`].
    pub fn of_deviations(&self, body: &Body, deviations: &PoseTable, rate: f64) -> Result<CoordinateTable> {
        let row = |(frame, row): (&usize, &Vec<f64>)| {
            body.check_pose(row).with_context(|| format!("the deviations of frame {frame}"))?;
            let values = body.dofs().zip(row).zip(&self.entries);
            Ok(values.map(|(((_, dof), value), (_, to))| (to.factor * in_opensim(dof.axis, *value)).abs()).collect())
        };
        let rows = deviations.frames.iter().zip(&deviations.poses).map(row).collect::<Result<_>>()?;
        self.table(&deviations.frames, rate, rows)
    }

    fn table(&self, frames: &[usize], rate: f64, rows: Vec<Vec<f64>>) -> Result<CoordinateTable> {
        ensure!(rate > 0.0 && rate.is_finite(), "the frame rate is {rate}, expected a positive number");
        let names = self.entries.iter().map(|(_, coordinate)| coordinate.name.clone()).collect();
        Ok(CoordinateTable { names, times: frames.iter().map(|frame| *frame as f64 / rate).collect(), rows })
    }
}

/// A value (mm, radians) in metres or degrees.
fn in_opensim(axis: DofAxis, value: f64) -> f64 {
    if axis.is_rotation() { value.to_degrees() } else { value / 1000.0 }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::motion::y_up;

    fn adult() -> Body {
        Body::adult(1750.0).unwrap()
    }

    fn column(table: &CoordinateTable, name: &str) -> f64 {
        table.rows[0][table.names.iter().position(|known| known == name).unwrap()]
    }

    #[test]
    fn every_known_degree_of_freedom_is_the_default_bodys() {
        let file: MappingFile = parse_toml(KNOWN, "known").unwrap();
        let names = adult().dof_names();
        assert!(file.coordinate.keys().all(|dof| names.contains(dof)), "{:?}", file.coordinate.keys());
        let coordinates = Coordinates::of_body(&adult()).unwrap();
        assert!(coordinates.entries.iter().any(|(dof, to)| dof == "head.ry" && to.name == "head_ry"));
        let again: MappingFile = parse_toml(&coordinates.to_toml(), "again").unwrap();
        assert_eq!(Coordinates::with(again, &adult()).unwrap(), coordinates);
    }

    #[test]
    fn the_pelvis_stands_and_turns_as_in_opensim() {
        let body = adult();
        let mut pose = body.standing_pose();
        pose[..6].copy_from_slice(&[1000.0, 200.0, 950.0, 0.2, -0.3, 1.1]);
        let table = PoseTable { frames: vec![50], poses: vec![pose.clone()] };
        let found = Coordinates::of_body(&body).unwrap().of_poses(&body, &table, 25.0).unwrap();
        assert_eq!(found.times, [2.0]);
        let at = |name: &str| column(&found, name);
        let bones = body.world_from_bones(&pose).unwrap();
        let place = DVec3::new(at("pelvis_tx"), at("pelvis_ty"), at("pelvis_tz"));
        assert!(place.distance(y_up(bones[0].translation) / 1000.0) < 1e-12, "{place}");
        // OpenSim turns a pelvis about z, its x, its y; at rest it faces x, with its right at z.
        let turned = DMat3::from_rotation_z(at("pelvis_tilt").to_radians())
            * DMat3::from_rotation_x(at("pelvis_list").to_radians())
            * DMat3::from_rotation_y(at("pelvis_rotation").to_radians());
        for (theirs, ours) in [(DVec3::X, DVec3::X), (DVec3::Y, DVec3::Z), (DVec3::Z, -DVec3::Y)] {
            let expected = y_up(bones[0].matrix3 * ours);
            assert!((turned * theirs).distance(expected) < 1e-12, "{} {expected}", turned * theirs);
        }
    }

    #[test]
    fn bending_counts_as_in_opensim() {
        let body = adult();
        let coordinates = Coordinates::of_body(&body).unwrap();
        // Raised forward, bent, moved to the middle: what OpenSim counts as positive moves the limb's end so (forward, left, up).
        let cases: [(&str, f64, &str, &str, DVec3); 7] = [
            ("left_hip.ry", -0.5, "hip_flexion_l", "left_knee", DVec3::X),
            ("left_hip.rx", -0.2, "hip_adduction_l", "left_knee", -DVec3::Y),
            ("right_hip.rx", 0.2, "hip_adduction_r", "right_knee", DVec3::Y),
            ("right_knee.ry", 0.5, "knee_angle_r", "right_ankle", -DVec3::X),
            ("right_shoulder.ry", -0.5, "arm_flex_r", "right_elbow", DVec3::X),
            ("left_elbow.ry", -0.5, "elbow_flex_l", "left_wrist", DVec3::X),
            ("thorax.ry", -0.2, "lumbar_extension", "head_top", -DVec3::X),
        ];
        let rest = vec![0.0; body.dof_count()];
        let joint = |pose: &[f64], name: &str| {
            let place = body.joint_index(name).unwrap();
            body.joint_positions(&body.world_from_bones(pose).unwrap())[place]
        };
        for (dof, value, name, end, towards) in cases {
            let mut pose = rest.clone();
            pose[body.dof_index(dof).unwrap()] = value;
            let table = PoseTable { frames: vec![0], poses: vec![pose.clone()] };
            let found = column(&coordinates.of_poses(&body, &table, 25.0).unwrap(), name);
            assert!((found - value.abs().to_degrees()).abs() < 1e-9, "{name} is {found}");
            assert!((joint(&pose, end) - joint(&rest, end)).dot(towards) > 30.0, "{name}");
        }
    }

    #[test]
    fn a_mapping_file_goes_before_the_usual_names() {
        let body = adult();
        let with = |text: &str| Coordinates::with(parse_toml(text, "names.toml").unwrap(), &body);
        let own =
            with("[coordinate]\n\"left_knee.ry\" = { name = \"knee_angle_l\", factor = -2, offset = 10 }\n").unwrap();
        let values = vec![0.5; body.dof_count()];
        let table = PoseTable { frames: vec![0], poses: vec![values] };
        let found = column(&own.of_poses(&body, &table, 25.0).unwrap(), "knee_angle_l");
        assert!((found - (10.0 - 2.0 * 0.5_f64.to_degrees())).abs() < 1e-12, "{found}");
        let found = own.of_deviations(&body, &table, 25.0).unwrap();
        assert!((column(&found, "knee_angle_l") - 1.0_f64.to_degrees()).abs() < 1e-12, "{found:?}");
        assert!((column(&found, "pelvis_ty") - 0.0005).abs() < 1e-12, "{found:?}");
        let refused = [
            (
                "[coordinate]\n\"left_knee.rx\" = { name = \"a\" }\n",
                "`left_knee.rx`, which is no degree of freedom, the nearest",
            ),
            (
                "[coordinate]\n\"left_knee.ry\" = { name = \"pelvis_tx\" }\n",
                "`pelvis.ty` and `left_knee.ry` both are the coordinate",
            ),
            ("[coordinate]\n\"left_knee.ry\" = { name = \"a b\" }\n", "expected a name without blanks"),
            ("[coordinate]\n\"left_knee.ry\" = { name = \"a\", factor = 0 }\n", "the factor not 0"),
        ];
        for (text, expected) in refused {
            let error = with(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{error} should say {expected}");
        }
    }
}
