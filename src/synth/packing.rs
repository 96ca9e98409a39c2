//! People in one instant, and views, as the stages under `glsl/synth/` read them.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use bytemuck::Zeroable;
use glam::{DAffine3, DVec3};

use super::actor::Material;
use super::figure::Figure;
use super::render::{Candidate, Cast, Member, View};
use super::shaders::{
    LOOK_FACE, LOOK_HAIR, LOOK_SHIRT, LOOK_SHOE, LOOK_SKIN, LOOK_TROUSERS, MEMBER_SHIFT, TILE_SIDE, layout,
};
use super::shadow::LightBins;
use super::solid::{PlacedSolid, Solid};
use super::triangle::{Primitive, Triangle};

/// The finishes of all people, and where each person's garments have theirs.
pub(super) struct PackedFinishes {
    pub(super) rows: Vec<layout::Finish>,
    /// By person and garment: one more than the row.
    numbers: Vec<BTreeMap<String, u32>>,
}

impl PackedFinishes {
    /// # Errors
    /// When a garment's material is drawn on the processor alone; the sentence names both.
    pub(super) fn new(figures: &[Figure]) -> Result<Self> {
        let (mut rows, mut numbers) = (Vec::new(), Vec::new());
        for (index, figure) in figures.iter().enumerate() {
            let mut own = BTreeMap::new();
            for (garment, finish) in figure.finishes() {
                let (tint, scale, material) =
                    finish.for_stages().with_context(|| format!("actor {}: {garment}", index + 1))?;
                let material = material.unwrap_or_else(layout::Material::zeroed);
                rows.push(layout::Finish { tint: with(tint, scale), material });
                own.insert(garment.clone(), rows.len() as u32);
            }
            numbers.push(own);
        }
        Ok(Self { rows, numbers })
    }

    fn number(&self, member: usize, material: Material) -> u32 {
        self.numbers[member].get(material.garment()).copied().unwrap_or(0)
    }
}

impl std::fmt::Debug for PackedFinishes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PackedFinishes").field("rows", &self.rows.len()).finish_non_exhaustive()
    }
}

/// Lists one after another: where each begins, the end of the last, then their entries.
fn lists(lists: impl Iterator<Item = Vec<u32>> + Clone) -> Vec<u32> {
    let mut words = Vec::new();
    let mut at = lists.clone().count() as u32 + 1;
    for list in lists.clone() {
        words.push(at);
        at += list.len() as u32;
    }
    words.push(at);
    words.extend(lists.flatten());
    words
}

/// Everything of an instant that is handed to the device.
pub(super) struct PackedCast {
    pub(super) members: Vec<layout::Member>,
    pub(super) solids: Vec<layout::Solid>,
    pub(super) triangles: Vec<layout::Triangle>,
    pub(super) bins: Vec<u32>,
    pub(super) balls: Vec<[f32; 4]>,
    pub(super) tiles: Vec<u32>,
}

impl PackedCast {
    /// # Errors
    /// When there are more primitives than candidates have numbers for.
    pub(super) fn new(cast: &Cast<'_>, views: &[View], is_wanted: &[bool], finishes: &PackedFinishes) -> Result<Self> {
        let (mut solids, mut triangles, mut members) = (Vec::new(), Vec::new(), Vec::new());
        let (mut bins, mut balls) = (Vec::new(), Vec::new());
        // Where the primitives of each member begin among all of their sort.
        let mut firsts = Vec::new();
        for (number, member) in cast.members.iter().enumerate() {
            let primitives = &member.figure.primitives;
            let is_mesh = matches!(primitives.first(), Some(Primitive::Triangle(_)));
            let first = if is_mesh { triangles.len() } else { solids.len() } as u32;
            firsts.push(first);
            for (index, primitive) in primitives.iter().enumerate() {
                let material = member.figure.material(index);
                let (look, finish) = (look_of(material), finishes.number(number, material));
                match primitive {
                    Primitive::Solid(solid) => {
                        let (object, is_jaw) = member.figure.object_of(index);
                        solids.push(packed_solid(solid, &object, [look, finish, u32::from(is_jaw)]));
                    }
                    Primitive::Triangle(triangle) => triangles.push(packed_triangle(triangle, look, finish)),
                }
            }
            members.push(packed_member(member, is_mesh, bins.len() as u32, balls.len() as u32 / 2));
            balls.extend(member.figure.balls.iter().flatten().map(|&(centre, radius)| with(centre, radius)));
            append_bins(&mut bins, &member.lamp.bins, first);
        }
        ensure!(
            solids.len().max(triangles.len()) < 1 << MEMBER_SHIFT && members.len() <= 1 << (32 - MEMBER_SHIFT),
            "there are {} solids and {} triangles of {} people, more than the stages have numbers for",
            solids.len(),
            triangles.len(),
            members.len()
        );
        let candidate =
            |&(member, index): &Candidate| u32::from(member) << MEMBER_SHIFT | (firsts[usize::from(member)] + index);
        let tiles: Vec<Vec<u32>> = views
            .iter()
            .zip(is_wanted)
            .flat_map(|(view, &is_wanted)| {
                let tiles = if is_wanted { view.tiles(cast) } else { vec![Vec::new(); tile_count(view)] };
                tiles.into_iter().map(|tile| tile.iter().map(|(primitive, _)| candidate(primitive)).collect())
            })
            .collect();
        // A device has no empty buffers.
        if solids.is_empty() {
            solids.push(layout::Solid::zeroed());
        }
        if triangles.is_empty() {
            triangles.push(layout::Triangle::zeroed());
        }
        Ok(Self { members, solids, triangles, bins, balls, tiles: lists(tiles.iter().cloned()) })
    }
}

/// The lists of a member's bins behind those of the members before.
fn append_bins(bins: &mut Vec<u32>, own: &LightBins<'_>, first_primitive: u32) {
    let base = bins.len() as u32;
    let words = lists(own.bins.iter().cloned());
    let starts = own.bins.len() + 1;
    bins.extend(words[..starts].iter().map(|start| start + base));
    bins.extend(words[starts..].iter().map(|primitive| primitive + first_primitive));
}

/// Tiles of a view.
pub(super) fn tile_count(view: &View) -> usize {
    let [width, height] = view.camera().size;
    (width.div_ceil(TILE_SIDE) * height.div_ceil(TILE_SIDE)) as usize
}

/// The views' headers; their pixels, corners and tiles lie one view after another.
pub(super) fn packed_views(views: &[View], is_wanted: &[bool]) -> Vec<layout::View> {
    let (mut first_pixel, mut first_corner, mut first_tile) = (0, 0, 0);
    let header = |(view, &is_wanted): (&View, &bool)| {
        let size @ [width, height] = view.camera().size;
        let tiles = tile_count(view) as u32;
        let header = layout::View {
            centre: view.centre.as_vec3().to_array(),
            is_wanted: u32::from(is_wanted),
            size,
            first_pixel,
            first_corner,
            first_tile,
            columns: width.div_ceil(TILE_SIDE),
            tiles,
            ..Zeroable::zeroed()
        };
        first_pixel += width * height;
        first_corner += (width + 1) * (height + 1);
        first_tile += tiles;
        header
    };
    views.iter().zip(is_wanted).map(header).collect()
}

fn with(v: DVec3, w: f64) -> [f32; 4] {
    v.extend(w).as_vec4().to_array()
}

fn look_of(material: Material) -> u32 {
    match material {
        Material::Skin => LOOK_SKIN,
        Material::Face => LOOK_FACE,
        Material::Hair => LOOK_HAIR,
        Material::Shirt => LOOK_SHIRT,
        Material::Trousers => LOOK_TROUSERS,
        Material::Shoe => LOOK_SHOE,
    }
}

fn packed_member(member: &Member<'_>, is_mesh: bool, first_bin: u32, first_pair: u32) -> layout::Member {
    let bins = &member.lamp.bins;
    layout::Member {
        to_light: with(member.lamp.to_light, 0.0),
        across: bins.across.map(|axis| with(axis, 0.0)),
        bins_origin: bins.origin.as_vec2().to_array(),
        bins_size: bins.size.map(|bins| bins as u32),
        bin_width: bins.width as f32,
        first_bin,
        is_mesh: u32::from(is_mesh),
        first_pair,
        pairs: member.figure.balls.len() as u32,
        floor_middle: member.lamp.shadow_middle.as_vec2().to_array(),
        ..Zeroable::zeroed()
    }
}

/// Rows of an affine map, with what stands in w.
fn rows(map: &DAffine3, w: [f64; 3]) -> [[f32; 4]; 3] {
    std::array::from_fn(|row| with(map.matrix3.row(row), w[row]))
}

fn packed_solid(solid: &PlacedSolid, object: &DAffine3, [look, finish, is_jaw]: [u32; 3]) -> layout::Solid {
    let (is_capsule, shape) = match solid.solid {
        Solid::Ball => (0, [0.0; 3]),
        Solid::Capsule { length, radius_a, radius_b } => (1, [length, radius_a, radius_b]),
    };
    layout::Solid {
        local: rows(&solid.local_from_world, shape),
        object: rows(object, object.translation.to_array()),
        centre: with(solid.bounding_balls()[0].0, solid.reach()),
        is_capsule,
        look,
        finish,
        is_jaw,
    }
}

fn packed_triangle(triangle: &Triangle, look: u32, finish: u32) -> layout::Triangle {
    layout::Triangle {
        corner: with(triangle.corner, 0.0),
        edges: triangle.edges.map(|edge| with(edge, 0.0)),
        normals: triangle.normals.map(|normal| with(normal, 0.0)),
        rest: triangle.rest.map(|corner| with(corner, 0.0)),
        look,
        finish,
        ..Zeroable::zeroed()
    }
}
