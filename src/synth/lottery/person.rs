//! Who is seen: stature, girths, skin, hair and clothes. The ranges are frozen (docs/SCENES.md): another one would make all that
//! was measured on these scenes another thing.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::super::finish::FinishSettings;
use super::super::scene::ActorSettings;
use super::draws::Draws;

/// Colours of skin from light to dark, sRGB.
const SKINS: [[f64; 3]; 7] = [
    [0.93, 0.78, 0.69],
    [0.87, 0.68, 0.56],
    [0.79, 0.58, 0.45],
    [0.66, 0.46, 0.34],
    [0.52, 0.35, 0.25],
    [0.39, 0.26, 0.19],
    [0.29, 0.19, 0.14],
];

/// Colours of hair; none is a bald head.
const HAIRS: [(f64, Option<[f64; 3]>); 8] = [
    (3.0, Some([0.08, 0.07, 0.07])),
    (3.0, Some([0.17, 0.11, 0.08])),
    (2.0, Some([0.31, 0.20, 0.12])),
    (2.0, Some([0.70, 0.57, 0.36])),
    (1.0, Some([0.49, 0.23, 0.11])),
    (1.0, Some([0.55, 0.54, 0.52])),
    (1.0, Some([0.82, 0.81, 0.79])),
    (1.0, None),
];

/// Lengths that differ among people of one stature, and by how much.
const LENGTHS: [(&str, f64); 9] = [
    ("trunk", 0.04),
    ("neck length", 0.08),
    ("head length", 0.04),
    ("shoulder width", 0.07),
    ("hip width", 0.08),
    ("upper arm", 0.05),
    ("forearm", 0.05),
    ("thigh", 0.04),
    ("calf", 0.05),
];

/// Girths, and the share of the person's stoutness that each takes.
const GIRTHS: [(&str, f64); 7] = [
    ("belly girth", 1.0),
    ("chest girth", 0.8),
    ("neck girth", 0.5),
    ("upper arm girth", 0.9),
    ("forearm girth", 0.6),
    ("thigh girth", 0.9),
    ("calf girth", 0.6),
];

/// A way to choose the colour of clothes.
#[derive(Clone, Copy)]
enum Dye {
    /// Nearly that of the walls (or, for trousers and shoes, of the floor).
    AsBehind,
    /// Nearly that of the skin.
    AsSkin,
    Dark,
    Light,
    Grey,
    Bright,
}

/// A person in a room of these colours; motion is yet to be chosen.
pub(super) fn person(draws: Draws, people: &[PathBuf], wall: [f64; 3], floor: [f64; 3]) -> ActorSettings {
    let mesh = if draws.chance("person/skinned", 0.75) { draws.among("person/file", people) } else { None };
    let skin = skin(draws);
    let hair = draws.one_of("person/hair", &HAIRS).flatten();
    let near = |name: &str, colour: [f64; 3]| {
        std::array::from_fn(|i| (colour[i] + draws.between(&format!("{name}/{i}"), [-0.03, 0.03])).clamp(0.0, 1.0))
    };
    let plain = |colour: [f64; 3]| FinishSettings { colour: Some(colour), ..FinishSettings::default() };
    let clothes = BTreeMap::from([
        ("skin".to_string(), plain(skin)),
        ("hair".to_string(), plain(hair.map_or(skin, |colour| near("person/hair tone", colour)))),
        ("shirt".to_string(), garment(draws, "shirt", wall, skin)),
        ("trousers".to_string(), garment(draws, "trousers", floor, skin)),
        ("shoes".to_string(), plain(dyed(draws, "shoes", floor, skin))),
    ]);
    ActorSettings {
        height: draws.about("person/height", [1450.0, 2000.0]).clamp(1500.0, 1950.0).round(),
        mesh: mesh.cloned(),
        own_bones: mesh.is_some(),
        long_sleeves: draws.chance("person/long sleeves", 0.4),
        shorts: draws.chance("person/shorts", 0.25),
        proportions: proportions(draws),
        clothes,
        ..ActorSettings::default()
    }
}

fn skin(draws: Draws) -> [f64; 3] {
    let tone = draws.unit("person/skin") * (SKINS.len() - 1) as f64;
    let (lighter, share) = (SKINS[tone as usize], tone.fract());
    let darker = SKINS[(tone as usize + 1).min(SKINS.len() - 1)];
    std::array::from_fn(|i| rounded(lighter[i] + (darker[i] - lighter[i]) * share))
}

fn proportions(draws: Draws) -> BTreeMap<String, f64> {
    let length = |(name, range): &(&str, f64)| {
        ((*name).to_string(), draws.between(&format!("person/{name}"), [1.0 - range, 1.0 + range]))
    };
    // Who is stout is so everywhere, more or less.
    let stoutness = draws.between("person/stoutness", [-0.16, 0.18]);
    let girth = |(name, share): &(&str, f64)| {
        let own = draws.between(&format!("person/{name}"), [-0.05, 0.05]);
        ((*name).to_string(), rounded((1.0 + share * stoutness + own).clamp(0.8, 1.2)))
    };
    LENGTHS.iter().map(length).chain(GIRTHS.iter().map(girth)).collect()
}

fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// A piece of clothing: plain, or cut out of a material.
fn garment(draws: Draws, name: &str, behind: [f64; 3], skin: [f64; 3]) -> FinishSettings {
    let colour = dyed(draws, name, behind, skin);
    let cloths = [(4.0, None), (4.0, Some("fabric")), (1.0, Some("marble")), (1.0, Some("granite"))];
    let material = draws.one_of(&format!("{name}/cloth"), &cloths).flatten();
    FinishSettings {
        colour: Some(colour),
        material: material.map(str::to_string),
        scale: material.map(|_| draws.between(&format!("{name}/scale"), [60.0, 300.0])),
        parameters: None,
        seed: material.map(|_| u64::from(draws.whole(&format!("{name}/seed"), [1, 1000]))),
    }
}

fn dyed(draws: Draws, name: &str, behind: [f64; 3], skin: [f64; 3]) -> [f64; 3] {
    let dyes = [
        (2.0, Dye::AsBehind),
        (0.5, Dye::AsSkin),
        (2.5, Dye::Dark),
        (1.5, Dye::Light),
        (1.5, Dye::Grey),
        (3.0, Dye::Bright),
    ];
    let of = |channel: usize, range: [f64; 2]| draws.between(&format!("{name}/dye {channel}"), range);
    let near = |colour: [f64; 3]| std::array::from_fn(|i| rounded((colour[i] + of(i, [-0.05, 0.05])).clamp(0.02, 1.0)));
    match draws.one_of(&format!("{name}/dye"), &dyes).unwrap_or(Dye::Grey) {
        Dye::AsBehind => near(behind),
        Dye::AsSkin => near(skin),
        Dye::Dark => std::array::from_fn(|i| of(i, [0.06, 0.26])),
        Dye::Light => std::array::from_fn(|i| of(i, [0.74, 0.96])),
        Dye::Grey => {
            let level = of(0, [0.25, 0.75]);
            std::array::from_fn(|i| rounded(level + 0.3 * of(i, [-0.1, 0.1])))
        }
        Dye::Bright => std::array::from_fn(|i| of(i, [0.08, 0.92])),
    }
}
