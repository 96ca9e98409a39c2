//! What surfaces are made of, where a scene says so: one colour, or a procedural material that the object is cut out of.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

use super::colour::Colour;
use super::shaders::layout;
use crate::texture::materials::{Material, Parameters};

/// A finish as scene.toml has it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct FinishSettings {
    /// One colour, sRGB 0 to 1; with a material: what its colours are multiplied by.
    pub colour: Option<[f64; 3]>,
    /// Name of a procedural material.
    pub material: Option<String>,
    /// Millimetres of the object to a unit of the material.
    pub scale: Option<f64>,
    /// The material's parameters: a table, or the name of a file.
    pub parameters: Option<FinishParameters>,
    /// Seed of the material.
    pub seed: Option<u64>,
}

/// Parameters of a material.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum FinishParameters {
    /// In a file.
    File(PathBuf),
    /// Here.
    Here(toml::Table),
}

/// A finish, ready to be looked up.
#[derive(Debug)]
pub struct Finish {
    tint: Colour,
    cut: Option<(Material, f64)>,
}

/// Millimetres to a unit of a material where a scene does not say.
const SCALE: f64 = 250.0;

impl FinishSettings {
    /// Looks the material up; `what` wears it, for messages.
    ///
    /// # Errors
    /// When nothing is named, the material is unknown, or a number is out of range.
    pub fn finish(&self, what: &str) -> Result<Finish> {
        let tint = match self.colour {
            Some(colour) => {
                if !colour.iter().all(|value| (0.0..=1.0).contains(value)) {
                    bail!("{what}: the colour is {colour:?}, expected three numbers from 0 to 1");
                }
                Colour::from(colour.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }))
            }
            None => Colour::ONE,
        };
        let scale = self.scale.unwrap_or(SCALE);
        if !(1.0..=1e5).contains(&scale) {
            bail!("{what}: the scale is {scale}, expected 1 to 100000 mm to a unit of the material");
        }
        let cut = match &self.material {
            Some(name) => {
                let parameters = match &self.parameters {
                    None => Parameters::Defaults,
                    Some(FinishParameters::File(path)) => Parameters::File(path),
                    Some(FinishParameters::Here(table)) => Parameters::Table(table),
                };
                let material = Material::new(name, parameters, self.seed.unwrap_or(1), None);
                Some((material.with_context(|| what.to_string())?, scale))
            }
            None if self.colour.is_some() => None,
            None => bail!("{what}: it names neither a colour nor a material, expected one of them"),
        };
        Ok(Finish { tint, cut })
    }
}

impl Finish {
    /// Reflectance at a point of the object, mm.
    pub fn at(&self, point: Colour) -> Colour {
        match &self.cut {
            None => self.tint,
            Some((material, scale)) => {
                let texel = material.at((point / *scale).as_vec3().to_array());
                // No surface sends all light back.
                self.tint * Colour::from(texel.linear().map(f64::from)).min(Colour::splat(0.9))
            }
        }
    }

    /// Tint, mm to a unit, and the material, if there is one.
    ///
    /// # Errors
    /// When the material is none that stages have.
    pub(super) fn for_stages(&self) -> Result<(Colour, f64, Option<layout::Material>)> {
        let Some((material, scale)) = &self.cut else { return Ok((self.tint, 1.0, None)) };
        let staged = material.for_scenes().context("its material is drawn on the processor alone")?;
        // The struct of one shader file, which the build writes down for each room.
        Ok((self.tint, *scale, Some(bytemuck::cast(staged))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_and_materials_are_looked_up() {
        let red = FinishSettings { colour: Some([1.0, 0.0, 0.0]), ..FinishSettings::default() };
        assert_eq!(red.finish("shirt").unwrap().at(Colour::ZERO), Colour::X);
        let wood =
            FinishSettings { material: Some("wood".into()), ..FinishSettings::default() }.finish("floor").unwrap();
        let colours: Vec<Colour> = (0..50).map(|i| wood.at(Colour::new(f64::from(i) * 11.0, 3.0, 40.0))).collect();
        assert!(colours.windows(2).any(|pair| pair[0] != pair[1]), "it varies");
        assert!(colours.iter().all(|colour| colour.min_element() >= 0.0 && colour.max_element() <= 0.9));
    }

    #[test]
    fn what_is_none_is_named() {
        let error = |settings: FinishSettings| format!("{:#}", settings.finish("the shirt").unwrap_err());
        assert!(error(FinishSettings::default()).contains("the shirt: it names neither"));
        let none = FinishSettings { material: Some("wodo".into()), ..FinishSettings::default() };
        assert!(error(none).contains("wood"));
        let loud = FinishSettings { colour: Some([2.0, 0.0, 0.0]), ..FinishSettings::default() };
        assert!(error(loud).contains("expected three numbers from 0 to 1"));
        let flat = FinishSettings { material: Some("wood".into()), scale: Some(0.0), ..FinishSettings::default() };
        assert!(error(flat).contains("the scale is 0"));
    }
}
