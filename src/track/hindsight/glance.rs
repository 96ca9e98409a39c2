//! Limbs sought by what the pictures say along their axes, before they are drawn: cheap enough for thousands of poses of a limb, where a
//! few dozen leave nothing near in the six degrees of freedom of an arm (METHOD A14).

use glam::DAffine3;
use rayon::prelude::*;

use super::shape::{Posed, Shape};
use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::{Observation, SeenView};
use crate::geometry::Camera;
use crate::track::sight::{pixel, said};

/// Places along the axis of a part that are looked at.
const PLACES: usize = 4;

/// A body's limbs, for looking at where they might be.
#[derive(Clone, Debug)]
pub(super) struct Glances {
    cameras: Vec<Camera>,
    limbs: Vec<Limb>,
}

/// A limb: its bones, parents first, each with the place of its values in a pose; its parts; and the body without them.
#[derive(Clone, Debug)]
struct Limb {
    bones: Vec<(usize, usize)>,
    parts: Vec<usize>,
    rest: Reference,
}

impl Glances {
    /// Of limbs by their degrees of freedom.
    pub(super) fn new(body: &Body, cameras: &[Camera], limbs: &[Vec<usize>]) -> Self {
        let of_dofs: Vec<usize> = body.dofs().map(|(bone, _)| bone).collect();
        let first = |bone: usize| body.bones[..bone].iter().map(|bone| bone.dofs.len()).sum::<usize>();
        let limb = |limb: &Vec<usize>| {
            let mut is_moved = vec![false; body.bones.len()];
            for &bone in &body.update_order {
                let follows = body.bones[bone].parent.is_some_and(|parent| is_moved[parent]);
                is_moved[bone] = follows || limb.iter().any(|&dof| of_dofs[dof] == bone);
            }
            let moved = body.update_order.iter().filter(|&&bone| is_moved[bone]);
            let (parts, others): (Vec<usize>, Vec<usize>) =
                (0..body.parts.len()).partition(|&part| is_moved[body.parts[part].bone]);
            let mut rest = body.clone();
            rest.parts = others.into_iter().map(|part| body.parts[part].clone()).collect();
            Limb {
                bones: moved.map(|&bone| (bone, first(bone))).collect(),
                parts,
                rest: Reference::new(&rest, cameras),
            }
        };
        Self { cameras: cameras.to_vec(), limbs: limbs.iter().map(limb).collect() }
    }

    /// Looks at a frame for a limb of a pose.
    pub(super) fn at<'a>(
        &'a self,
        shape: &'a Shape,
        limb: usize,
        pose: &[f32],
        observations: &'a [Observation],
    ) -> Glance<'a> {
        let limb = &self.limbs[limb];
        let covered = (0..self.cameras.len()).into_par_iter().map(|view| limb.rest.draw(pose, view).bytes).collect();
        let mut posed = Posed::default();
        shape.pose(pose, &mut posed);
        let views = SeenView::all(observations);
        Glance { cameras: &self.cameras, body: &shape.body, limb, bones: posed.bones, views, covered }
    }
}

/// What a frame says of a limb, with the rest of the body where it is.
pub(super) struct Glance<'a> {
    cameras: &'a [Camera],
    body: &'a Body,
    limb: &'a Limb,
    /// Where the bones of the pose are.
    bones: Vec<DAffine3>,
    views: Vec<SeenView<'a>>,
    /// Of each view's pixels, which ones the rest of the body covers: not 0.
    covered: Vec<Vec<u8>>,
}

impl Glance<'_> {
    /// What is said of the limb as `row` has it: the mean over places along its axes and views, from -1 to 1, and nothing where the rest of
    /// the body is anyway. `bones` is memory that is used again.
    fn support_in(&self, row: &[f32], bones: &mut Vec<DAffine3>) -> f32 {
        bones.clone_from(&self.bones);
        for &(bone, first) in &self.limb.bones {
            let posed = &self.body.bones[bone];
            let mut values = [0.0; 6];
            for (value, given) in values.iter_mut().zip(row.iter().skip(first).take(posed.dofs.len())) {
                *value = f64::from(*given);
            }
            let moved = posed.parent_from_bone(&values);
            bones[bone] = posed.parent.map_or(moved, |parent| bones[parent] * moved);
        }
        let (mut sum, mut count) = (0.0, 0);
        for part in self.limb.parts.iter().map(|&part| &self.body.parts[part]) {
            let [a, b] = [part.a, part.b].map(|end| bones[part.bone].transform_point3(end));
            for place in 0..PLACES {
                let at = a.lerp(b, (place as f64 + 0.5) / PLACES as f64);
                for ((camera, view), covered) in self.cameras.iter().zip(&self.views).zip(&self.covered) {
                    if let Some(pixel) = pixel(camera, *view, at) {
                        count += 1;
                        if covered[pixel] == 0 {
                            sum += said(*view, pixel, part.label);
                        }
                    }
                }
            }
        }
        if count > 0 { sum / count as f32 } else { 0.0 }
    }

    /// What is said of the limb as a row has it.
    pub(super) fn support(&self, row: &[f32]) -> f32 {
        self.support_in(row, &mut Vec::new())
    }

    /// The `count` rows of which most is said, and what, in falling order; of equals the first.
    pub(super) fn best(&self, rows: Vec<Vec<f32>>, count: usize) -> Vec<(f32, Vec<f32>)> {
        let supports: Vec<f32> =
            rows.par_iter().with_min_len(64).map_init(Vec::new, |bones, row| self.support_in(row, bones)).collect();
        let mut ranked: Vec<(f32, Vec<f32>)> = supports.into_iter().zip(rows).collect();
        ranked.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        ranked.truncate(count);
        ranked
    }
}
