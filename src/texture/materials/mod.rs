//! Materials: a colour and a height for every point of space, so that a solid object is cut out of them (METHOD B2).

mod brick;
mod clouds;
mod fabric;
#[cfg(test)]
mod golden;
mod granite;
mod grass;
mod lava;
mod marble;
mod midpoint;
mod skin;
mod solid;
mod space;
mod staged;
mod terrain;
#[cfg(test)]
mod tests;
mod timber;
mod wood;

use std::path::Path;

use anyhow::{Result, anyhow, bail};
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use brick::Brick;
pub use clouds::Clouds;
pub use fabric::Fabric;
pub use granite::Granite;
pub use grass::Grass;
pub use lava::Lava;
pub use marble::Marble;
pub(super) use midpoint::Displacement;
pub use midpoint::Surface;
pub use skin::Skin;
pub(crate) use solid::Solid;
pub use solid::Texel;
pub use space::Space;
use staged::{Staged, StagedSum};
pub use terrain::{Band, Fractal, Map, Terrain};
pub use timber::Timber;
pub use wood::Wood;

use super::noise::{NoiseMaker, NoiseWay};
use super::shaders::{MATERIALS_OF_CLOTHES, layout};
use crate::files::{choices, parse_table, read_toml};

/// Where a material's parameters come from; what is not said is the default.
#[derive(Clone, Copy, Debug)]
pub enum Parameters<'a> {
    /// Nowhere.
    Defaults,
    /// A TOML file.
    File(&'a Path),
    /// A table of another file.
    Table(&'a toml::Table),
}

impl Parameters<'_> {
    fn read<T: DeserializeOwned + Default>(self) -> Result<T> {
        match self {
            Self::Defaults => Ok(T::default()),
            Self::File(path) => read_toml(path),
            Self::Table(table) => parse_table(table, "parameters"),
        }
    }

    /// Fails where a number is not finite or beyond what sums of octaves stay finite with.
    fn check(self) -> Result<()> {
        let (table, name) = match self {
            Self::Defaults => return Ok(()),
            Self::File(path) => (read_toml(path)?, path.display().to_string()),
            Self::Table(table) => (table.clone(), "parameters".into()),
        };
        check_numbers(&toml::Value::Table(table), "").map_err(|message| anyhow!("{name}: {message}"))
    }
}

/// Parameters and seed to the material.
type Build = fn(Parameters<'_>, u64) -> Result<Box<dyn Solid>>;

fn built<T: Solid + DeserializeOwned + Default + 'static>(
    parameters: Parameters<'_>,
    _: u64,
) -> Result<Box<dyn Solid>> {
    Ok(Box::new(parameters.read::<T>()?))
}

/// How a material is made, and its parameters as a file has them.
struct Made {
    build: Build,
    defaults: fn() -> Result<String>,
}

impl Made {
    const fn of<T: Solid + DeserializeOwned + Serialize + Default + 'static>() -> Self {
        Self { build: built::<T>, defaults: defaults::<T> }
    }
}

fn defaults<T: Serialize + Default>() -> Result<String> {
    Ok(toml::to_string(&T::default())?)
}

choices! {
    /// A material by name.
    "material" pub enum MaterialKind => made: Made {
        /// sky through four octaves of noise
        "clouds" Clouds => Made::of::<Clouds>(),
        /// lava, or a sun's surface (also called `sun`): turbulence about the means of the octaves
        "lava" Lava => Made::of::<Lava>(),
        /// layers bent by turbulence
        "marble" Marble => Made::of::<Marble>(),
        /// grey grains: the highest octave alone
        "granite" Granite => Made::of::<Granite>(),
        /// rings about the y axis, disturbed by noise, with a fine grain
        "wood" Wood => Made::of::<Wood>(),
        /// wood of floors and furniture: even rings about the y axis
        "timber" Timber => Made::of::<Timber>(),
        /// a wall in running bond with mortar
        "brick" Brick => Made::of::<Brick>(),
        /// blades over blades, fresh and dry
        "grass" Grass => Made::of::<Grass>(),
        /// woven threads, plain or twill
        "fabric" Fabric => Made::of::<Fabric>(),
        /// mottled skin with freckles and pores
        "skin" Skin => Made::of::<Skin>(),
        /// terrain by random mid-point displacement, in colour bands
        "fractal" Fractal => Made {
            build: |parameters, seed| Ok(Box::new(parameters.read::<Fractal>()?.displaced(seed))),
            defaults: defaults::<Fractal>,
        },
        /// terrain by noise, in colour bands with isolines
        "terrain" Terrain => Made::of::<Terrain>(),
    }
}

/// What lava is called too: the formula is that of a sun's surface.
const SUN: &str = "sun";

impl MaterialKind {
    /// The material of a name, or of another name that one is known by.
    ///
    /// # Errors
    /// When there is none: the nearest is named.
    pub fn of(name: &str) -> Result<Self> {
        Self::from_name(if name == SUN { Self::Lava.name() } else { name })
    }

    /// Its parameters with their defaults, as a file of parameters has them (TOML).
    ///
    /// # Errors
    /// When they are no TOML, which a test holds them to.
    pub fn defaults(self) -> Result<String> {
        (self.made().defaults)()
    }
}

/// A material, ready to be looked up.
pub struct Material {
    solid: Box<dyn Solid>,
    seed: u64,
    tile: Option<[f32; 2]>,
    source: NoiseMaker,
}

impl std::fmt::Debug for Material {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Material").field("seed", &self.seed).field("tile", &self.tile).finish_non_exhaustive()
    }
}

impl Material {
    /// The material called `name` with `parameters`. With a `tile` it repeats itself after those lengths along x and y, object
    /// units: its frequencies become whole numbers of cells a tile.
    ///
    /// # Errors
    /// When there is none of that name (the nearest is named), when the parameters have an unknown key or a number that is not
    /// finite or beyond 1e6, or when the tile is not a positive length.
    pub fn new(name: &str, parameters: Parameters<'_>, seed: u64, tile: Option<[f32; 2]>) -> Result<Self> {
        Self::of_noise(NoiseWay::Arithmetic, name, parameters, seed, tile)
    }

    /// [`Self::new`] with its noise coming about in another way: the same material, of another piece.
    ///
    /// # Errors
    /// As [`Self::new`], and of a tile from a cube of noise, whose own period is no length of a tile.
    pub fn of_noise(
        way: NoiseWay,
        name: &str,
        parameters: Parameters<'_>,
        seed: u64,
        tile: Option<[f32; 2]>,
    ) -> Result<Self> {
        let kind = MaterialKind::of(name)?;
        if let Some(tile) = tile.filter(|tile| !tile.iter().all(|length| (1e-3..=1e4).contains(length))) {
            bail!("a tile of {} x {} units, expected lengths from 0.001 to 10000", tile[0], tile[1]);
        }
        if tile.is_some() && way == NoiseWay::Volume {
            bail!(
                "noise of a volume repeats after its own 16 cells and not after a tile, expected arithmetic or tables"
            );
        }
        parameters.check()?;
        Ok(Self { solid: (kind.made().build)(parameters, seed)?, seed, tile, source: NoiseMaker::new(way, seed) })
    }

    fn space(&self) -> Space<'_> {
        Space::new(self.seed, self.tile, &self.source)
    }

    /// Where its noise comes from.
    pub(super) fn source(&self) -> &NoiseMaker {
        &self.source
    }

    /// The texel at a point, object units. The same on every call and thread.
    pub fn at(&self, p: [f32; 3]) -> Texel {
        let texel = self.solid.at(&self.space(), p.map(|x| if x.is_finite() { x.clamp(-1e6, 1e6) } else { 0.0 }));
        Texel { colour: texel.colour.map(|c| c.clamp(0.0, 1.0)), height: texel.height.clamp(0.0, 1.0) }
    }

    /// Samples along each axis that a pixel of `pixel` units needs, so that detail finer than it is its mean instead of noise or moire: two
    /// for each cell, `least` at least and 16 at most.
    pub fn samples(&self, pixel: f32, least: u32) -> u32 {
        ((2.0 * self.solid.finest().abs() * pixel).min(16.0).ceil() as u32).max(least)
    }

    /// The material for the stages of scenes, with the bits of [`Self::at`]; none where they do not have it.
    pub(crate) fn for_scenes(&self) -> Option<layout::Material> {
        Some(self.for_stages().0).filter(|material| material.kind <= MATERIALS_OF_CLOTHES)
    }

    /// The material for stages, its bands of colour, and the surface whose heights stand behind them.
    pub(super) fn for_stages(&self) -> (layout::Material, Vec<f32>, Option<Displacement>) {
        let Staged { kind, numbers, sums, bands, surface } = self.solid.staged(&self.space());
        let mut material = layout::Material { kind, dice: self.space().dice(), ..bytemuck::Zeroable::zeroed() };
        material.numbers.iter_mut().zip(numbers).for_each(|(number, value)| *number = value);
        let mut first = 0;
        for (word, StagedSum { sum, octaves }) in material.sums.iter_mut().zip(sums) {
            *word = first as u32 | (octaves.len() as u32) << 8 | (sum as u32) << 16;
            material.octaves.iter_mut().skip(first).zip(&octaves).for_each(|(place, octave)| *place = *octave);
            first += octaves.len();
        }
        (material, bands, surface)
    }
}

/// Every number of a parameter file is finite and of a size that sums of octaves stay finite with.
fn check_numbers(value: &toml::Value, key: &str) -> std::result::Result<(), String> {
    match value {
        toml::Value::Float(x) if !(-1e6..=1e6).contains(x) => {
            Err(format!("{key} = {x}, expected a number from -1e6 to 1e6"))
        }
        toml::Value::Array(items) => items.iter().try_for_each(|item| check_numbers(item, key)),
        toml::Value::Table(table) => table.iter().try_for_each(|(key, item)| check_numbers(item, key)),
        _ => Ok(()),
    }
}
