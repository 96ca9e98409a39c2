use proptest::prelude::*;

use super::*;
use crate::body::Skinning;

const SMALL: &str = r#"
name = "pointer"
units = "mm"
[[bone]]
name = "hand"
parent = ""
offset = [0, 0, 0]
dof = ["tx", "rz"]
limits = { tx = [-10, 10], rz = [-90, 90] }
step = { tx = 2, rz = 5 }
[[bone]]
name = "finger"
parent = "hand"
offset = [50, 0, 0]
dof = ["ry"]
[[part]]
name = "palm"
bone = "hand"
a = [0, 0, 0]
b = [50, 0, 0]
radius_a = 20
radius_b = 15
label = 1
[[part]]
name = "tip"
bone = "finger"
a = [0, 0, 0]
b = [30, 0, 0]
radius_a = 9
radius_b = 7
label = 2
[[marker]]
name = "NAIL"
bone = "finger"
at = [30, 0, 5]
"#;

#[test]
fn a_small_body_loads_with_its_defaults() {
    let body = parse_body(SMALL, "pointer.toml").unwrap();
    assert_eq!(body.dof_names(), ["hand.tx", "hand.rz", "finger.ry"]);
    assert_eq!(body.bones[0].dofs[1].limits, [-90.0_f64.to_radians(), 90.0_f64.to_radians()]);
    assert_eq!(body.bones[0].dofs[1].step, 5.0_f64.to_radians());
    let finger = body.bones[1].dofs[0];
    assert_eq!((finger.limits, finger.step), ([-180.0_f64.to_radians(), 180.0_f64.to_radians()], 5.0_f64.to_radians()));
    assert_eq!(body.joint_names(), ["hand", "finger"]);
}

#[test]
fn units_scale_every_length_and_no_angle() {
    let mm = parse_body(SMALL, "mm").unwrap();
    for (units, scale) in [("cm", 10.0), ("m", 1000.0)] {
        let other = parse_body(&SMALL.replace("\"mm\"", &format!("\"{units}\"")), units).unwrap();
        assert_eq!(other.bones[1].offset, mm.bones[1].offset * scale);
        assert_eq!(other.bones[0].dofs[0].limits, [-10.0 * scale, 10.0 * scale]);
        assert_eq!(other.bones[0].dofs[0].step, 2.0 * scale);
        assert_eq!(other.bones[0].dofs[1], mm.bones[0].dofs[1]);
        assert_eq!(other.parts[1].b, mm.parts[1].b * scale);
        assert_eq!(other.parts[1].radius_b, 7.0 * scale);
        assert_eq!(other.markers[0].at, mm.markers[0].at * scale);
    }
}

#[test]
fn every_bad_body_has_its_sentence() {
    let tree = |parents: &[(&str, &str)]| {
        let bones: String = parents
            .iter()
            .map(|(name, parent)| format!("[[bone]]\nname = \"{name}\"\nparent = \"{parent}\"\noffset = [0, 0, 1]\n"))
            .collect();
        format!("name = \"tree\"\n{bones}")
    };
    let change = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        SMALL.replacen(from, to, 1)
    };
    let long_chain: Vec<(String, String)> =
        (0..5000).map(|i| (format!("b{i}"), if i == 4999 { "b0".into() } else { format!("b{}", i + 1) })).collect();
    let mut long: Vec<(&str, &str)> = long_chain.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    long.push(("root", ""));
    let cases = [
        (String::new(), vec!["missing field `name`"]),
        ("name = \"empty\"".into(), vec!["has no [[bone]]"]),
        (tree(&[("a", "")]), vec!["has no [[part]]"]),
        (tree(&[("a", ""), ("b", "")]), vec!["bones `a` and `b` are both roots"]),
        (tree(&[("a", "b"), ("b", "a")]), vec!["no bone has parent = \"\""]),
        (tree(&[("a", ""), ("b", "d"), ("c", "b"), ("d", "c")]), vec!["b -> d -> c -> b form a cycle"]),
        (tree(&[("a", ""), ("e", "b"), ("b", "b")]), vec!["bones b -> b form a cycle"]),
        (tree(&long), vec!["form a cycle"]),
        (tree(&[("a", ""), ("a", "a")]), vec!["two bones are named `a`"]),
        (tree(&[("", "")]), vec!["bone number 1 has an empty name"]),
        (tree(&[("a.b", "")]), vec!["bone name \"a.b\" holds '.'"]),
        (tree(&[("left hip", "")]), vec!["holds ' '"]),
        (change("parent = \"hand\"", "parent = \"hnad\""), vec!["bone `finger`", "parent is `hnad`", "`hand`"]),
        (change("bone = \"finger\"", "bone = \"fingr\""), vec!["part `tip`", "bone is `fingr`", "`finger`"]),
        (change("at = [30, 0, 5]", "at = [30, nan, 5]"), vec!["marker `NAIL`", "at holds NaN"]),
        (change("name = \"tip\"", "name = \"palm\""), vec!["two parts are named `palm`"]),
        (format!("{SMALL}[[marker]]\nname = \"NAIL\"\nbone = \"hand\"\nat = [0, 0, 0]\n"), vec!["two markers"]),
        (change("label = 2", "label = 1"), vec!["parts `palm` and `tip` both have label 1"]),
        (change("label = 2", "label = 0"), vec!["part `tip`", "label is 0, expected 1 to 127"]),
        (change("label = 2", "label = 128"), vec!["label is 128, expected 1 to 127"]),
        (change("label = 2", "label = -1"), vec!["label is -1"]),
        (change("label = 2", "label = 2.0"), vec!["pointer.toml, line 31", "expected i64"]),
        (change("tx = [-10, 10]", "tx = [10, -10]"), vec!["bone `hand`", "limits of `tx` are [10, -10]"]),
        (change("tx = [-10, 10]", "tx = [nan, 10]"), vec!["limits of `tx` is NaN"]),
        (change("rz = [-90, 90]", "rz = [-inf, 90]"), vec!["limits of `rz` is -inf", "degrees"]),
        (change("rz = [-90, 90]", "rz = [-90]"), vec!["pointer.toml, line 9", "invalid length 1"]),
        (change("limits = { tx", "limits = { ty"), vec!["bone `hand`", "limits names `ty`", "nearest", "`tx`"]),
        (change("step = { tx", "step = { rx"), vec!["step names `rx`"]),
        (change("tx = 2", "tx = -2"), vec!["step of `tx` is -2"]),
        (change("tx = 2", "tx = 1e300"), vec!["step of `tx` is 1", "up to 1000000 mm"]),
        (change("[\"tx\", \"rz\"]", "[\"rz\", \"tx\"]"), vec!["dof lists `tx` after `rz`", "tx ty tz rx ry rz"]),
        (change("[\"tx\", \"rz\"]", "[\"tx\", \"tx\", \"rz\"]"), vec!["dof lists `tx` twice"]),
        (
            change("[\"ry\"]", "[\"yaw\"]"),
            vec!["bone `finger`", "unknown dof `yaw`", "the nearest is `tx` (known: tx, ty, tz, rx, ry, rz)"],
        ),
        (
            change("dof = [\"ry\"]", "dof = [\"ry\"]\norder = \"xxz\""),
            vec!["unknown order `xxz`", "xyz, xzy, yxz, yzx, zxy, zyx"],
        ),
        (change("offset = [50, 0, 0]", "offset = [inf, 0, 0]"), vec!["bone `finger`", "offset holds inf", "units"]),
        (change("offset = [50, 0, 0]", "offset = [1e12, 0, 0]"), vec!["offset holds 1000000000000"]),
        (change("offset = [50, 0, 0]", "offset = [50, 0]"), vec!["line 14", "invalid length 2"]),
        (change("offset = [50, 0, 0]", "offset = \"near\""), vec!["line 14", "string"]),
        (change("radius_b = 7", "radius_b = -7"), vec!["part `tip`", "radius_b is -7, expected more than 0"]),
        (change("radius_b = 7", "radius_b = 0"), vec!["radius_b is 0"]),
        (change("radius_b = 7", "radius_b = nan"), vec!["radius_b is NaN"]),
        (change("radius_b = 7", "radius_b = inf"), vec!["radius_b is inf"]),
        (change("b = [30, 0, 0]", "b = [0, 0, 0]"), vec!["part `tip`", "a and b are the same point"]),
        (change("units = \"mm\"", "units = \"inch\""), vec!["line 3", "unknown unit `inch`", "known: mm, cm, m"]),
        (change("radius_a = 9", "radius = 9"), vec!["line 29", "unknown key `radius`", "`radius_"]),
        (change("label = 2", ""), vec!["missing field `label`"]),
        (format!("{SMALL}[mesh]\nfiel = \"a.glb\"\n"), vec!["unknown key `fiel`", "`file`"]),
        (format!("{SMALL}[mesh]\n"), vec!["table [mesh]", "neither `file` nor `frusta`"]),
        (format!("{SMALL}[mesh]\nfile = \"a\"\nfrusta = \"square\"\n"), vec!["both `file` and `frusta`"]),
        (
            format!("{SMALL}[mesh]\nfrusta = \"round\"\n"),
            vec!["unknown frusta `round`, the nearest is `square` (known: square, elliptic)"],
        ),
        (format!("{SMALL}[mesh]\nfrusta = \"square\"\nvertices = 9\n"), vec!["vertices is 9, expected 8"]),
        (format!("{SMALL}[mesh]\nfrusta = \"elliptic\"\nvertices = 60\n"), vec!["vertices is 60", "18, 34, 66"]),
        (format!("{SMALL}[mesh]\nfrusta = \"square\"\nskinning = \"rigid\"\n"), vec!["`skinning` stands beside"]),
        (format!("{SMALL}[mesh]\nfile = \"a\"\nvertices = 8\n"), vec!["`vertices` stands beside `file`"]),
        (
            format!("{SMALL}[mesh]\nfile = \"a\"\nskinning = \"soft\"\n"),
            vec!["unknown skinning `soft`", "rigid, smooth"],
        ),
        (format!("{SMALL}[mesh]\nfile = \"a\"\n[mesh.bones]\nfiner = \"b\"\n"), vec!["`finer`", "`finger`"]),
        (
            format!("{SMALL}[mesh]\nfrusta = \"square\"\nflattening = {{ plam = 0.5 }}\n"),
            vec!["`plam`, which is no part", "`palm`"],
        ),
        (format!("{SMALL}[mesh]\nfrusta = \"square\"\nflattening = {{ palm = nan }}\n"), vec!["of `palm` is NaN"]),
        (SMALL[..SMALL.len() - 8].to_string(), vec!["pointer.toml, line 3"]),
    ];
    for (text, sentences) in cases {
        let error = format!("{:#}", parse_body(&text, "pointer.toml").unwrap_err());
        assert!(error.starts_with("pointer.toml") && !error.contains('\n'), "{error}");
        for sentence in sentences {
            assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
        }
    }
}

#[test]
fn files_are_loaded_and_saved_with_their_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("body.toml");
    let mesh =
        "[mesh]\nfile = \"person \\\"x\\\".glb\"\nskinning = \"rigid\"\n[mesh.bones]\nfinger = \"a:b \\\"c\\\"\"\n";
    std::fs::write(&path, format!("{SMALL}{mesh}")).unwrap();
    let body = Body::load(&path).unwrap();
    let expected = MeshSource::Skinned {
        file: folder.path().join("person \"x\".glb"),
        skinning: Skinning::Rigid,
        joints: BTreeMap::from([("finger".to_string(), "a:b \"c\"".to_string())]),
    };
    assert_eq!(body.mesh, Some(expected));
    std::fs::create_dir(folder.path().join("elsewhere")).unwrap();
    let copy = folder.path().join("elsewhere/body.toml");
    body.save(&copy, crate::files::Overwrite::Refuse).unwrap();
    assert_eq!(Body::load(&copy).unwrap(), body);
    assert!(format!("{:#}", body.save(&copy, crate::files::Overwrite::Refuse).unwrap_err()).contains("--force"));
    let error = format!("{:#}", Body::load(&folder.path().join("nobody.toml")).unwrap_err());
    assert!(error.contains("nobody.toml"), "{error}");
    std::fs::write(&path, change_first(SMALL, "label = 2", "label = 1")).unwrap();
    let error = format!("{:#}", Body::load(&path).unwrap_err());
    assert!(error.contains("body.toml") && error.contains("both have label 1"), "{error}");
}

fn change_first(text: &str, from: &str, to: &str) -> String {
    text.replacen(from, to, 1)
}

#[test]
fn frusta_survive_their_own_file() {
    let text = format!("{SMALL}[mesh]\nfrusta = \"elliptic\"\nvertices = 130\nflattening = {{ palm = 0.6 }}\n");
    let body = parse_body(&text, "pointer.toml").unwrap();
    let base = crate::body::FrustumBase::Elliptic { vertices: 130 };
    let expected = MeshSource::Frusta { base, flattening: BTreeMap::from([("palm".to_string(), 0.6)]) };
    assert_eq!(body.mesh, Some(expected));
    assert_eq!(parse_body(&body.to_toml(), "again").unwrap(), body);
    assert_eq!(crate::body::Mesh::of_body(&body).unwrap().vertices.len(), 260);
}

#[test]
fn scaling_scales_lengths_and_leaves_the_room() {
    let body = parse_body(&SMALL.replace("[\"ry\"]", "[\"tz\", \"ry\"]\nlimits = { tz = [-1, 2] }"), "x").unwrap();
    let twice = body.scaled(2.0).unwrap();
    assert_eq!(twice.bones[1].offset, body.bones[1].offset * 2.0);
    assert_eq!(twice.bones[1].dofs[0].limits, [-2.0, 4.0]);
    assert_eq!(twice.bones[0].dofs, body.bones[0].dofs);
    assert_eq!(twice.parts[0].radius_b, 30.0);
    assert_eq!(twice.markers[0].at, body.markers[0].at * 2.0);
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(body.scaled(factor).unwrap_err().to_string().contains("expected 0.01 to 100"));
    }
}

#[test]
fn the_default_body_survives_its_own_file() {
    let body = Body::adult(1750.0).unwrap();
    assert_eq!(parse_body(&body.to_toml(), "adult").unwrap(), body);
    assert!(body.to_toml().contains("limits = { ry = [0, 150] }"), "whole degrees stay whole");
    let odd = Body::adult(1687.3).unwrap();
    assert_eq!(parse_body(&odd.to_toml(), "odd").unwrap(), odd);
}

proptest! {
    #[test]
    fn any_cut_or_changed_file_is_a_body_or_a_sentence(
        cut in 0..SMALL.len(), at in 0..SMALL.len(), byte in "[ -~\n]"
    ) {
        for text in [SMALL[..cut].to_string(), format!("{}{byte}{}", &SMALL[..at], &SMALL[at + 1..])] {
            if let Err(error) = parse_body(&text, "cut.toml") {
                let error = format!("{error:#}");
                prop_assert!(error.starts_with("cut.toml"), "{}", error);
            }
        }
    }
}
