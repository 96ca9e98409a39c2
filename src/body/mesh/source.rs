//! Where a body's mesh comes from: the `[mesh]` table of `body.toml` (FORMATS).

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::{Result, anyhow, bail, ensure};
use serde::Deserialize;

use crate::files::{choices, expected, shortened, unknown};

/// Where the mesh of a body comes from (METHOD A4).
#[derive(Clone, Debug, PartialEq)]
pub enum MeshSource {
    /// A skinned person in a glTF file.
    Skinned {
        /// The file; [`crate::body::Body::load`] makes it absolute, seen from the folder of the body's file.
        file: PathBuf,
        /// Whether its weights are kept, or each vertex hangs on its heaviest bone alone.
        skinning: Skinning,
        /// Names of the file's joints by bones and free ends of the body, where the names themselves do not tell.
        joints: BTreeMap<String, String>,
    },
    /// Generated from the parts.
    Frusta {
        /// The base.
        base: FrustumBase,
        /// Ratio of depth to width by part, where not 1.
        flattening: BTreeMap<String, f64>,
    },
}

choices! {
    /// How the vertices of a [`super::Mesh`] hang on bones.
    #[derive(Default)]
    "skinning" pub enum Skinning {
        /// Each on one bone.
        "rigid" Rigid,
        /// Each on up to four bones.
        "smooth" #[default] Smooth,
    }
}

/// The base of generated frusta.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrustumBase {
    /// Four corners an end: 8 vertices a part.
    Square,
    /// Two rings, and a vertex in the centre of either cap.
    Elliptic {
        /// Vertices a part, one of [`FrustumBase::LADDER`].
        vertices: u32,
    },
}

impl FrustumBase {
    /// Vertices a part with an elliptic base: 2 cap centres and 2 rings of 8, 16, 32, 64, 128 and 256.
    pub const LADDER: [u32; 6] = [18, 34, 66, 130, 258, 514];

    /// Vertices a part.
    pub fn vertices(self) -> u32 {
        match self {
            Self::Square => 8,
            Self::Elliptic { vertices } => vertices,
        }
    }

    /// The name as files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Elliptic { .. } => "elliptic",
        }
    }
}

/// `[mesh]` as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshEntry {
    file: Option<PathBuf>,
    skinning: Option<Skinning>,
    #[serde(default)]
    bones: BTreeMap<String, String>,
    frusta: Option<String>,
    vertices: Option<i64>,
    #[serde(default)]
    flattening: BTreeMap<String, f64>,
}

/// The source that `[mesh]` names, for a body with the given parts, and joints as [`crate::body::Body::joint_names`].
pub(crate) fn build_source(entry: MeshEntry, parts: &[&str], joints: &[&str]) -> Result<MeshSource> {
    let MeshEntry { file, skinning, bones, frusta, vertices, flattening } = entry;
    match (file, frusta) {
        (Some(file), None) => {
            for (key, is_there) in [("vertices", vertices.is_some()), ("flattening", !flattening.is_empty())] {
                ensure!(!is_there, "`{key}` stands beside `file`, expected it beside `frusta`");
            }
            let skinning = skinning.unwrap_or_default();
            for name in bones.keys() {
                let is_known = joints.contains(&name.as_str());
                ensure!(is_known, "bones names `{}`, which is no bone, {}", shortened(name), expected(name, joints));
            }
            Ok(MeshSource::Skinned { file, skinning, joints: bones })
        }
        (None, Some(base)) => {
            for (key, is_there) in [("skinning", skinning.is_some()), ("bones", !bones.is_empty())] {
                ensure!(!is_there, "`{key}` stands beside `frusta`, expected it beside `file`");
            }
            let base = frustum_base(&base, vertices)?;
            check_flattening(&flattening, parts)?;
            Ok(MeshSource::Frusta { base, flattening })
        }
        (Some(_), Some(_)) => bail!("it has both `file` and `frusta`, expected one of them"),
        (None, None) => bail!("it has neither `file` nor `frusta`, expected one of them"),
    }
}

fn frustum_base(name: &str, vertices: Option<i64>) -> Result<FrustumBase> {
    match name {
        "square" => {
            let vertices = vertices.unwrap_or(8);
            ensure!(vertices == 8, "vertices is {vertices}, expected 8 with square frusta");
            Ok(FrustumBase::Square)
        }
        "elliptic" => {
            let asked = vertices.unwrap_or(66);
            let rung = FrustumBase::LADDER.into_iter().find(|&rung| i64::from(rung) == asked);
            let vertices =
                rung.ok_or_else(|| anyhow!("vertices is {asked}, expected one of {:?}", FrustumBase::LADDER))?;
            Ok(FrustumBase::Elliptic { vertices })
        }
        other => Err(unknown("frusta", other, &["square", "elliptic"])),
    }
}

/// Holds ratios of depth to width to the parts they name.
pub(super) fn check_flattening(flattening: &BTreeMap<String, f64>, parts: &[&str]) -> Result<()> {
    for (name, ratio) in flattening {
        let is_known = parts.contains(&name.as_str());
        ensure!(is_known, "flattening names `{}`, which is no part, {}", shortened(name), expected(name, parts));
        ensure!((0.1..=10.0).contains(ratio), "flattening of `{name}` is {ratio}, expected 0.1 to 10");
    }
    Ok(())
}
