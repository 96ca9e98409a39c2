//! Looking for limbs: what the pictures say of them along their axes, without drawing them. Cheap enough for thousands of poses of a limb,
//! where a few dozen leave nothing near in the six degrees of freedom of an arm (METHOD A14).

use std::ops::{ControlFlow, Range};

use anyhow::Result;
use glam::DAffine3;
use rayon::prelude::*;

use super::sight::{Place, along, is_known, said, said_of};
use crate::body::Body;
use crate::evaluate::{Evaluator, Objective, Reference};
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::search::SearchSpace;

/// Places along the axis of a part that are looked at.
const PLACES: usize = 4;
/// More than means of what places say differ by for being summed up in another order.
const ROUNDING: f32 = 1e-3;
/// By how many pixels of a view one of the pictures of the rest of the body is wide.
const COARSE: u32 = 4;

/// A body's limbs, for looking at where they might be.
#[derive(Clone, Debug)]
pub(super) struct Glances {
    body: Body,
    cameras: Vec<Camera>,
    limbs: Vec<Limb>,
}

/// A limb: its degrees of freedom, root to end, and a lattice over their limits; its bones, parents first, each with the place of its values in
/// a pose; its parts, each with how many of these bones are to be posed for it; and the body without them.
#[derive(Clone, Debug)]
struct Limb {
    dofs: Vec<usize>,
    lattice: Lattice,
    bones: Vec<(usize, usize)>,
    parts: Vec<(usize, usize)>,
    rest: Reference,
}

impl Glances {
    /// Of the limbs of a body, seen by cameras at working size.
    pub(super) fn new(body: &Body, cameras: &[Camera], space: &SearchSpace) -> Self {
        let coarse = |camera: &Camera| camera.scaled(camera.size.map(|side| side.div_ceil(COARSE)));
        let coarse: Vec<Camera> = cameras.iter().map(coarse).collect();
        let of_dofs: Vec<usize> = body.dofs().map(|(bone, _)| bone).collect();
        let first = |bone: usize| body.bones[..bone].iter().map(|bone| bone.dofs.len()).sum::<usize>();
        let limb = |group: usize| {
            let dofs: Vec<usize> = (0..space.dof_count()).filter(|&dof| space.groups()[dof] == group).collect();
            let mut is_moved = vec![false; body.bones.len()];
            for &bone in &body.update_order {
                let follows = body.bones[bone].parent.is_some_and(|parent| is_moved[parent]);
                is_moved[bone] = follows || dofs.iter().any(|&dof| of_dofs[dof] == bone);
            }
            let bones: Vec<(usize, usize)> =
                body.update_order.iter().filter(|&&bone| is_moved[bone]).map(|&bone| (bone, first(bone))).collect();
            let (parts, others): (Vec<usize>, Vec<usize>) =
                (0..body.parts.len()).partition(|&part| is_moved[body.parts[part].bone]);
            let mut rest = body.clone();
            rest.parts = others.into_iter().map(|part| body.parts[part].clone()).collect();
            let posed_for =
                |part: usize| bones.iter().take_while(|(bone, _)| *bone != body.parts[part].bone).count() + 1;
            let parts = parts.into_iter().map(|part| (part, posed_for(part))).collect();
            Limb { lattice: Lattice::new(space, &dofs), dofs, bones, parts, rest: Reference::new(&rest, &coarse) }
        };
        let count = space.groups().iter().max().copied().unwrap_or(0);
        Self { limbs: (1..=count).map(limb).collect(), body: body.clone(), cameras: cameras.to_vec() }
    }

    /// The degrees of freedom of each limb, root to end.
    pub(super) fn limbs(&self) -> impl ExactSizeIterator<Item = &[usize]> {
        self.limbs.iter().map(|limb| &*limb.dofs)
    }

    /// Those of one.
    pub(super) fn limb(&self, limb: usize) -> &[usize] {
        &self.limbs[limb].dofs
    }

    /// Looks at a frame for a limb of a pose, all views side by side.
    ///
    /// # Errors
    /// When the pose does not fit the body.
    pub(super) fn at<'a>(&'a self, limb: usize, pose: &[f32], views: &'a [SeenView<'a>]) -> Result<Glance<'a>> {
        let limb = &self.limbs[limb];
        let values: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
        let bones = self.body.world_from_bones(&values)?;
        let covered = (0..self.cameras.len()).into_par_iter().map(|view| limb.rest.draw(pose, view).bytes).collect();
        Ok(Glance { glances: self, limb, pose: pose.to_vec(), bones, views, covered })
    }
}

/// What a frame says of a limb, with the rest of the body where it is.
pub(super) struct Glance<'a> {
    glances: &'a Glances,
    limb: &'a Limb,
    pose: Vec<f32>,
    /// Where its bones are.
    bones: Vec<DAffine3>,
    views: &'a [SeenView<'a>],
    /// Of each view, coarsely, which pixels the rest of the body covers: not 0.
    covered: Vec<Vec<u8>>,
}

/// Who scored the frame last, and by what: asked where the host does not know what was seen.
pub(super) struct Seer<'a> {
    pub(super) evaluator: &'a mut dyn Evaluator,
    pub(super) objective: &'a Objective,
}

impl Glance<'_> {
    /// Shows `look` all places along the axes of the limb as `row` has it, in all views, until it has seen enough; none of one that the rest of
    /// the body covers. Bones are posed as far as the next part needs them, since most looks end with the limb's first. `bones` is memory that
    /// is used again, for this limb alone.
    fn places(&self, row: &[f32], bones: &mut Vec<DAffine3>, mut look: impl FnMut(Option<Place>) -> ControlFlow<()>) {
        let Glances { body, cameras, .. } = self.glances;
        if bones.is_empty() {
            bones.clone_from(&self.bones);
        }
        let mut bones_posed = 0;
        for &(part, posed_for) in &self.limb.parts {
            for &(bone, first) in &self.limb.bones[bones_posed..bones_posed.max(posed_for)] {
                let posed = &body.bones[bone];
                let mut values = [0.0; 6];
                for (value, given) in values.iter_mut().zip(row.iter().skip(first).take(posed.dofs.len())) {
                    *value = f64::from(*given);
                }
                let moved = posed.parent_from_bone(&values);
                bones[bone] = posed.parent.map_or(moved, |parent| bones[parent] * moved);
            }
            bones_posed = bones_posed.max(posed_for);
            let part = &body.parts[part];
            let axis = [part.a, part.b].map(|end| bones[part.bone].transform_point3(end));
            for place in along(cameras, self.views, axis, part.label, PLACES) {
                let width = cameras[place.view].size[0].div_ceil(COARSE) as usize;
                let [x, y] = place.at.map(|at| at / COARSE as usize);
                let is_covered = self.covered[place.view][y * width + x] != 0;
                if look((!is_covered).then_some(place)).is_break() {
                    return;
                }
            }
        }
    }

    /// What is said of the limb as each row has it: the mean over places along its axes and views, from -1 to 1, and nothing where the rest of
    /// the body is anyway.
    pub(super) fn support(&self, seer: Seer<'_>, rows: &[Vec<f32>]) -> Result<Vec<f32>> {
        if is_known(seer.objective, self.views) {
            let support = |bones: &mut Vec<DAffine3>, row: &Vec<f32>| self.known_support(row, bones, f32::NEG_INFINITY);
            return Ok(rows.par_iter().with_min_len(64).map_init(Vec::new, support).collect());
        }
        asked_support(seer, self.views, &self.all_places(rows))
    }

    /// The places of each row, none of one that the rest of the body covers.
    fn all_places(&self, rows: &[Vec<f32>]) -> Vec<Vec<Option<Place>>> {
        let places = |bones: &mut Vec<DAffine3>, row: &Vec<f32>| {
            let mut places = Vec::new();
            self.places(row, bones, |place| {
                places.push(place);
                ControlFlow::Continue(())
            });
            places
        };
        rows.par_iter().with_min_len(64).map_init(Vec::new, places).collect()
    }

    /// The same of one row by views that the host knows; anything less than `least` where it is that.
    fn known_support(&self, row: &[f32], bones: &mut Vec<DAffine3>, least: f32) -> f32 {
        let (mut sum, mut count) = (0.0_f32, 0);
        let most = self.limb.parts.len() * PLACES * self.views.len();
        self.places(row, bones, |place| {
            count += 1;
            sum += place.map_or(0.0, |place| said(self.views, &place));
            // Each of the others can say 1 at most.
            let left = most - count;
            let hope = (sum + left as f32) / most as f32;
            if hope < least - ROUNDING { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        mean(sum, count)
    }

    /// `count` poses of the limb on a lattice over its limits.
    pub(super) fn lattice(&self, count: usize) -> Vec<Vec<f32>> {
        self.limb.lattice.rows(&self.pose, 0..count)
    }

    /// The `most` poses of the limb of which most is said, in falling order, of `count` on a lattice over its limits; of equals the first.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn best(&self, seer: Seer<'_>, count: usize, most: usize) -> Result<Vec<Vec<f32>>> {
        let rows = self.lattice(count);
        let support = self.support(seer, &rows)?;
        let mut ranked: Vec<(f32, Vec<f32>)> = support.into_iter().zip(rows).collect();
        ranked.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Ok(ranked.into_iter().take(most).map(|(_, row)| row).collect())
    }

    /// [`are_elsewhere`] of one in views that the host knows.
    fn is_known_elsewhere(&self, count: usize, margin: f32) -> bool {
        let here = self.known_support(&self.pose, &mut Vec::new(), f32::NEG_INFINITY);
        if here + margin > 1.0 + ROUNDING {
            // Nothing says more than 1.
            return false;
        }
        let is_better = |(bones, row): &mut (Vec<DAffine3>, Vec<f32>), point: usize| {
            self.limb.lattice.put(point, row);
            self.known_support(row, bones, here + margin) - here > margin
        };
        let memory = || (Vec::new(), self.pose.clone());
        (0..count).into_par_iter().with_min_len(64).map_init(memory, is_better).any(|is_better| is_better)
    }
}

/// Of each limb of a frame, whether more is said of it, by more than `margin`, in one of `count` poses elsewhere than where it is. A device
/// that knows is asked once for all of them.
///
/// # Errors
/// When the evaluator fails.
pub(super) fn are_elsewhere(
    seer: Seer<'_>,
    views: &[SeenView<'_>],
    limbs: &[Glance<'_>],
    count: usize,
    margin: f32,
) -> Result<Vec<bool>> {
    if is_known(seer.objective, views) {
        return Ok(limbs.par_iter().map(|limb| limb.is_known_elsewhere(count, margin)).collect());
    }
    let places = |limb: &Glance<'_>| {
        let mut rows = limb.lattice(count);
        rows.push(limb.pose.clone());
        limb.all_places(&rows)
    };
    let places: Vec<Vec<Option<Place>>> = limbs.par_iter().flat_map_iter(places).collect();
    let support = asked_support(seer, views, &places)?;
    let is_elsewhere = |support: &[f32]| {
        let (here, there) = support.split_last().unwrap_or((&0.0, &[]));
        there.iter().any(|there| there - here > margin)
    };
    Ok(support.chunks(count + 1).map(is_elsewhere).collect())
}

/// What is said of each row's places, which an evaluator's device knows: the mean, nothing where there is none.
fn asked_support(seer: Seer<'_>, views: &[SeenView<'_>], of_rows: &[Vec<Option<Place>>]) -> Result<Vec<f32>> {
    let asked: Vec<Place> = of_rows.iter().flatten().flatten().copied().collect();
    let mut said = said_of(seer.evaluator, seer.objective, views, &asked)?.into_iter();
    let support = |places: &Vec<Option<Place>>| {
        let said = places.iter().map(|place| place.and_then(|_| said.next()).unwrap_or(0.0));
        mean(said.fold(0.0, |sum, said| sum + said), places.len())
    };
    Ok(of_rows.iter().map(support).collect())
}

fn mean(sum: f32, count: usize) -> f32 {
    if count > 0 { sum / count as f32 } else { 0.0 }
}

/// A lattice over the limits of some degrees of freedom, of as many points as are asked for: it fills them more evenly than random numbers
/// (Roberts 2018).
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    moved: Vec<Moved>,
}

/// A degree of freedom, its lower limit and how far the upper one is from there, and the share of that by which points are apart.
#[derive(Clone, Copy, Debug)]
struct Moved {
    dof: usize,
    lower: f32,
    width: f32,
    step: f64,
}

impl Lattice {
    pub(super) fn new(space: &SearchSpace, moved: &[usize]) -> Self {
        let root = plastic(moved.len());
        let moved = moved.iter().zip(1..).map(|(&dof, power)| {
            let [lower, upper] = [space.lower()[dof], space.upper()[dof]];
            Moved { dof, lower, width: upper - lower, step: root.powi(-power) }
        });
        Self { moved: moved.collect() }
    }

    /// Puts what moves in `row` to a point.
    fn put(&self, point: usize, row: &mut [f32]) {
        for Moved { dof, lower, width, step } in &self.moved {
            let share = (0.5 + (point + 1) as f64 * step).fract();
            row[*dof] = lower + share as f32 * width;
        }
    }

    /// `pose` with what moves at each of these points.
    pub(super) fn rows(&self, pose: &[f32], points: Range<usize>) -> Vec<Vec<f32>> {
        let row = |point: usize| {
            let mut row = pose.to_vec();
            self.put(point, &mut row);
            row
        };
        points.map(row).collect()
    }
}

/// The root of x^(n + 1) = x + 1 above 1.
fn plastic(dimensions: usize) -> f64 {
    let power = 1.0 / (dimensions as f64 + 1.0);
    (0..40).fold(1.5_f64, |x, _| (1.0 + x).powf(power))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::ObjectiveKind;
    use crate::evaluate::cpu::Cpu;
    use crate::track::fit_tests::{cameras_around, seen};

    /// What is passed over, because it can no longer say enough, is nothing that would have.
    #[test]
    fn what_is_passed_over_says_too_little() {
        let body = Body::adult(1750.0).unwrap();
        let (space, cameras) = (SearchSpace::of(&body).unwrap(), cameras_around());
        let standing = body.standing_pose();
        let mut raised = standing.clone();
        let shoulder = body.dof_index("left_shoulder.rx").unwrap();
        raised[shoulder] = 1.3;
        let observations = seen(&body, &cameras, &raised);
        let views = SeenView::all(&observations);
        let glances = Glances::new(&body, &cameras, &space);
        let mut cpu = Cpu::new(&body, &cameras).unwrap();
        let objective = Objective::of(ObjectiveKind::Sp);
        let mut answers = [0; 2];
        for pose in [&standing, &raised] {
            let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
            for limb in 0..glances.limbs().len() {
                let glance = glances.at(limb, &pose, &views).unwrap();
                let mut rows = glance.lattice(300);
                rows.push(pose.clone());
                let mut support = glance.support(Seer { evaluator: &mut cpu, objective: &objective }, &rows).unwrap();
                let here = support.pop().unwrap();
                let most = support.into_iter().fold(-1.0, f32::max);
                for margin in (-20..=20).map(|tenths| tenths as f32 / 10.0).chain([most - here, most - here - 1e-6]) {
                    let seer = Seer { evaluator: &mut cpu, objective: &objective };
                    let found = are_elsewhere(seer, &views, std::slice::from_ref(&glance), 300, margin).unwrap()[0];
                    assert_eq!(found, most - here > margin, "limb {limb}: {most} over {here} by {margin}");
                    answers[usize::from(found)] += 1;
                }
            }
        }
        assert!(answers[0] > 50 && answers[1] > 50, "{answers:?}");
    }
}
