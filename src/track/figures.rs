//! Who stands where in a frame: people whose silhouettes overlap in pictures are apart in space (METHOD A3).

use std::sync::Arc;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::hull::is_person;
use crate::features::blobs::{Components, Connectivity};
use crate::features::{BitImage, Region, SeenView};
use crate::geometry::Camera;
use crate::sequence::nearest_to_axes;

/// Side of a voxel, mm; larger where the place would have more than [`MOST`] of them.
const SIDE: f64 = 60.0;
const MOST: f64 = 4e6;
/// A blob smaller than this share of the largest in its view is nobody.
const BLOB: f64 = 0.1;
/// How far rays through the middles of two blobs may miss each other, and how far off somebody may be, mm.
const MISSED: f64 = 600.0;
const FARTHEST: f64 = 40_000.0;
/// How far somebody reaches from the middle of what is seen: sideways, up and down, mm.
const REACH: [f64; 2] = [1200.0, 1600.0];
/// Height of a column that only a trunk or a leg fills, mm.
const UPRIGHT: f64 = 450.0;
/// Legs nearer to each other are one person's, mm.
const APART: f64 = 500.0;
/// How far what is not upright may be from what is, mm: an arm's length.
const ARM: f64 = 900.0;
/// Height of the highest column of somebody, from the crotch to the crown or of a leg, mm: arms that hang from a bent trunk have less.
const STANDING: f64 = 700.0;
/// Height and volume of somebody, as shares of the tallest's and the largest's; these are no more than so much, mm and cubic mm, since who leaves the
/// pictures of some cameras has what the others see in common far above and behind him.
const TALL: f64 = 0.5;
const LARGE: f64 = 0.25;
const TALLEST: f64 = 2000.0;
const LARGEST: f64 = 0.12e9;
/// Share of a figure that nobody else covers in two views at least: what is seen where the rays of others cross is nobody.
const OWN: f64 = 0.3;

/// Somebody in a frame.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    /// The middle of the volume, over the floor: world x and y, mm.
    pub(super) place: DVec2,
    /// From the lowest to the highest point, mm.
    pub(super) height: f64,
    /// Of the highest column, mm.
    upright: f64,
    voxels: Vec<DVec3>,
    /// Of the voxels, mm.
    side: f64,
}

/// The people who are seen in a frame, those first who stand nearest to where the cameras look.
pub(super) fn figures(cameras: &[Camera], views: &[SeenView<'_>]) -> Vec<Figure> {
    let Some(block) = Block::around(cameras, views) else { return Vec::new() };
    let columns = block.columns(cameras, views);
    let mut figures = block.figures(&columns);
    let tallest = figures.iter().map(|figure| figure.height).fold(0.0, f64::max).min(TALLEST);
    figures.retain(|figure| figure.height >= TALL * tallest && figure.upright >= STANDING);
    let largest = figures.iter().map(Figure::volume).fold(0.0, f64::max).min(LARGEST);
    figures.retain(|figure| figure.volume() >= LARGE * largest);
    let mut figures = explaining(cameras, views, figures);
    if let Some(middle) = nearest_to_axes(cameras).map(DVec3::truncate) {
        figures.sort_by(|a, b| a.place.distance(middle).total_cmp(&b.place.distance(middle)));
    }
    figures
}

/// Those of the figures who explain the silhouettes together, beginning with who explains most of what is left: what is seen where the rays of
/// others cross explains nothing more than they do.
fn explaining(cameras: &[Camera], views: &[SeenView<'_>], figures: Vec<Figure>) -> Vec<Figure> {
    let all: Vec<BitImage> = views.iter().map(|view| view.silhouette()).collect();
    let mut left = all.clone();
    let within = |silhouettes: &[BitImage], covered: &[BitImage]| -> Vec<f64> {
        let count = |(silhouette, covered): (&BitImage, &BitImage)| {
            let mut outside = silhouette.clone();
            outside.and_not(covered);
            f64::from(silhouette.count() - outside.count())
        };
        silhouettes.iter().zip(covered).map(count).collect()
    };
    let mut unsure: Vec<(Figure, Vec<BitImage>)> = figures
        .into_iter()
        .map(|figure| {
            let covered = figure.covers(cameras);
            (figure, covered)
        })
        .collect();
    let mut sure = Vec::new();
    loop {
        let gain = |covered: &[BitImage]| -> f64 {
            let shares = within(&left, covered).into_iter().zip(&all);
            shares.map(|(new, all)| new / f64::from(all.count().max(1))).sum()
        };
        unsure.retain(|(_, covered)| {
            let shares = within(&left, covered).into_iter().zip(within(&all, covered));
            shares.filter(|(own, all)| *own > OWN * all).count() >= 2
        });
        let gains = unsure.iter().map(|(_, covered)| gain(covered)).enumerate();
        let Some((best, _)) = gains.max_by(|a, b| a.1.total_cmp(&b.1)) else { return sure };
        let (figure, covered) = unsure.swap_remove(best);
        left.iter_mut().zip(&covered).for_each(|(left, covered)| left.and_not(covered));
        sure.push(figure);
    }
}

/// The one of them who stands nearest to a place.
pub(super) fn nearest(figures: &[Figure], place: DVec2) -> Option<usize> {
    (0..figures.len()).min_by(|a, b| figures[*a].place.distance(place).total_cmp(&figures[*b].place.distance(place)))
}

/// For each view the pixels that show other figures than his `own`, and blobs of silhouettes that show nothing of him.
pub(super) fn others(
    cameras: &[Camera],
    views: &[SeenView<'_>],
    figures: &[Figure],
    own: usize,
) -> Vec<Option<Arc<BitImage>>> {
    let covered: Vec<Vec<BitImage>> = figures.iter().map(|figure| figure.covers(cameras)).collect();
    let view = |(at, view): (usize, &SeenView<'_>)| {
        let [width, height] = view.size();
        let [mut his, mut others] = [(); 2].map(|()| BitImage::new(width, height));
        for (who, covered) in covered.iter().enumerate() {
            if own == who { &mut his } else { &mut others }.or(&covered[at]);
        }
        let mut strange = view.silhouette();
        let mut touched = strange.clone();
        Components::default().keep_touched(&mut touched, &his);
        strange.and_not(&touched);
        others.or(&strange);
        others.and_not(&his);
        Some(Arc::new(others))
    };
    views.iter().enumerate().map(view).collect()
}

impl Figure {
    /// How many views have all of it in their pictures.
    pub(super) fn whole_in(&self, cameras: &[Camera]) -> usize {
        let is_whole = |camera: &&Camera| self.voxels.iter().all(|voxel| camera.sees(*voxel));
        cameras.iter().filter(is_whole).count()
    }

    /// Cubic mm.
    fn volume(&self) -> f64 {
        self.voxels.len() as f64 * self.side.powi(3)
    }

    /// The pixels of each view that its voxels cover.
    fn covers(&self, cameras: &[Camera]) -> Vec<BitImage> {
        let view = |camera: &Camera| {
            let [width, height] = camera.size;
            let mut covered = BitImage::new(width, height);
            for voxel in &self.voxels {
                let beside = camera.project(*voxel + DVec3::Z * 0.5 * self.side);
                let (Some(at), Some(beside)) = (camera.project(*voxel), beside) else { continue };
                // To the corners of a cube, and to the middles of the pixels there.
                let reach = 1.5 * at.distance(beside) + 0.5;
                let range = |at: f64, size: u32| {
                    let [low, high] = [at - reach, at + reach].map(|end| end.round().clamp(0.0, f64::from(size)));
                    low as u32..(high as u32 + 1).min(size)
                };
                for y in range(at.y, height) {
                    range(at.x, width).for_each(|x| covered.set(x, y, true));
                }
            }
            covered
        };
        cameras.par_iter().map(view).collect()
    }
}

/// The part of space in which somebody may stand, in voxels.
struct Block {
    /// Its lowest corner, world, mm.
    from: DVec3,
    side: f64,
    /// Voxels along x, y and z.
    size: [usize; 3],
}

/// The heights of a column that every camera sees as person.
type Column = Vec<f64>;

impl Block {
    /// Round all places where the middles of blobs of two views are; none where that is nowhere.
    fn around(cameras: &[Camera], views: &[SeenView<'_>]) -> Option<Self> {
        let blobs: Vec<Vec<Region>> = views.iter().map(|view| large_blobs(*view)).collect();
        let rays: Vec<Vec<(DVec3, DVec3)>> =
            cameras.iter().zip(&blobs).map(|(camera, blobs)| rays(camera, blobs)).collect();
        let is_seen = |at: &DVec3| {
            let mut seen = cameras.iter().zip(&blobs);
            seen.all(|(camera, blobs)| !camera.sees(*at) || blobs.iter().any(|blob| is_beside(camera, *blob, *at)))
        };
        let mut corners: Option<[DVec3; 2]> = None;
        for (view, one) in rays.iter().enumerate() {
            for (a, b) in rays[view + 1..].iter().flatten().flat_map(|b| one.iter().map(move |a| (a, b))) {
                let Some(at) = meeting(*a, *b).filter(is_seen) else { continue };
                let reach = DVec3::new(REACH[0], REACH[0], REACH[1]);
                let [low, high] = corners.unwrap_or([at - reach, at + reach]);
                corners = Some([low.min(at - reach), high.max(at + reach)]);
            }
        }
        let [from, to] = corners?;
        let volume = (to - from).to_array().into_iter().product::<f64>();
        let side = SIDE.max((volume / MOST).cbrt());
        let size = (to - from).to_array().map(|way| (way / side).ceil() as usize);
        Some(Self { from, side, size })
    }

    fn columns(&self, cameras: &[Camera], views: &[SeenView<'_>]) -> Vec<Column> {
        let [wide, deep, high] = self.size;
        let column = |at: usize| {
            let heights = (0..high).map(|z| self.from.z + (z as f64 + 0.5) * self.side);
            let [x, y] = self.middle(at).to_array();
            heights.filter(|z| is_person(cameras, views, DVec3::new(x, y, *z))).collect()
        };
        (0..wide * deep).into_par_iter().map(column).collect()
    }

    /// The middle of a column over the floor.
    fn middle(&self, column: usize) -> DVec2 {
        let [wide, ..] = self.size;
        let [x, y] = [column % wide, column / wide].map(|at| (at as f64 + 0.5) * self.side);
        self.from.truncate() + DVec2::new(x, y)
    }

    /// Puts columns together: upright ones that are near each other, and what is near those.
    fn figures(&self, columns: &[Column]) -> Vec<Figure> {
        let filled = |at: &usize| !columns[*at].is_empty();
        let is_upright = |at: &usize| columns[*at].len() as f64 * self.side >= UPRIGHT;
        let (upright, low): (Vec<usize>, Vec<usize>) = (0..columns.len()).filter(filled).partition(is_upright);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for at in upright {
            let place = self.middle(at);
            let is_near =
                |group: &Vec<usize>| group.iter().any(|other| self.middle(*other).distance(place) <= 1.5 * self.side);
            let (near, far): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_near);
            groups = far;
            groups.push(near.into_iter().flatten().chain([at]).collect());
        }
        let place = |group: &[usize]| {
            let (sum, count) = group.iter().fold((DVec2::ZERO, 0.0), |(sum, count), at| {
                let weight = columns[*at].len() as f64;
                (sum + weight * self.middle(*at), count + weight)
            });
            sum / count
        };
        // Legs apart are one person's.
        let mut people: Vec<Vec<usize>> = Vec::new();
        groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
        for group in groups {
            match people.iter_mut().find(|other| place(other).distance(place(&group)) < APART) {
                Some(other) => other.extend(group),
                None => people.push(group),
            }
        }
        let places: Vec<Vec<DVec2>> =
            people.iter().map(|person| person.iter().map(|at| self.middle(*at)).collect()).collect();
        for at in low {
            let way = |places: &Vec<DVec2>| {
                places.iter().map(|other| other.distance(self.middle(at))).fold(f64::INFINITY, f64::min)
            };
            let ways = places.iter().map(way).enumerate();
            let nearest = ways.min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.filter(|(_, way)| *way < ARM).into_iter().for_each(|(who, _)| people[who].push(at));
        }
        people.iter().map(|person| self.figure(person, columns, place(person))).collect()
    }

    fn figure(&self, own: &[usize], columns: &[Column], place: DVec2) -> Figure {
        let of_column = |at: &usize| {
            let middle = self.middle(*at);
            columns[*at].iter().map(move |z| middle.extend(*z))
        };
        let voxels: Vec<DVec3> = own.iter().flat_map(of_column).collect();
        let heights = || voxels.iter().map(|voxel| voxel.z);
        let height = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min) + self.side;
        let upright = own.iter().map(|at| columns[*at].len()).max().unwrap_or(0) as f64 * self.side;
        Figure { place, height, upright, voxels, side: self.side }
    }
}

/// Rays through the middles of the blobs of a view.
fn rays(camera: &Camera, blobs: &[Region]) -> Vec<(DVec3, DVec3)> {
    let middle = |low: u32, high: u32| 0.5 * f64::from(low + high - 1);
    let ray = |bounds: &Region| camera.ray(DVec2::new(middle(bounds.x0, bounds.x1), middle(bounds.y0, bounds.y1)));
    blobs.iter().filter_map(ray).collect()
}

/// Whether a place is seen in a blob's box, or beside it by half of its size.
fn is_beside(camera: &Camera, blob: Region, place: DVec3) -> bool {
    let within = |at: f64, low: u32, high: u32| {
        let [low, high] = [low, high].map(f64::from);
        (at - 0.5 * (low + high)).abs() <= high - low
    };
    camera.project(place).is_some_and(|at| within(at.x, blob.x0, blob.x1) && within(at.y, blob.y0, blob.y1))
}

/// Where the blobs of a view are that may be somebody.
fn large_blobs(view: SeenView<'_>) -> Vec<Region> {
    let mut components = Components::default();
    let blobs = components.find(&view.silhouette(), Connectivity::Eight);
    let largest = blobs.iter().map(|blob| blob.area).max().unwrap_or(0);
    let large = blobs.iter().filter(|blob| f64::from(blob.area) >= BLOB * f64::from(largest));
    large.map(|blob| blob.bounds).collect()
}

/// The place half way between two rays where they are nearest to each other; none where they miss each other or meet behind a camera.
fn meeting((from, along): (DVec3, DVec3), (other_from, other_along): (DVec3, DVec3)) -> Option<DVec3> {
    let between = other_from - from;
    let cosine = along.dot(other_along);
    let sine_squared = 1.0 - cosine * cosine;
    if sine_squared < 1e-6 {
        return None;
    }
    let way = (between.dot(along) - cosine * between.dot(other_along)) / sine_squared;
    let other_way = (cosine * between.dot(along) - between.dot(other_along)) / sine_squared;
    let [one, other] = [from + way * along, other_from + other_way * other_along];
    let is_there = [way, other_way].iter().all(|way| (0.0..FARTHEST).contains(way)) && one.distance(other) < MISSED;
    is_there.then_some(0.5 * (one + other))
}

#[cfg(test)]
mod tests {
    use super::super::fit_tests::{cameras_around, seen, standing_at, together};
    use super::*;
    use crate::body::Body;
    use crate::features::Observation;

    const PLACES: [[f64; 2]; 3] = [[-100.0, 150.0], [700.0, -550.0], [-750.0, -650.0]];

    fn seen_at(place: [f64; 2], cameras: &[Camera]) -> Vec<Observation> {
        let body = Body::adult(1700.0).unwrap();
        seen(&body, cameras, &standing_at(&body, place))
    }

    #[test]
    fn people_are_told_apart_where_they_stand() {
        let cameras = cameras_around();
        let alone = PLACES.map(|place| seen_at(place, &cameras));
        for count in 1..=PLACES.len() {
            let observations = together(&alone[..count]);
            let found = figures(&cameras, &SeenView::all(&observations));
            println!("{:.0?}", found.iter().map(|figure| (figure.place, figure.height)).collect::<Vec<_>>());
            assert_eq!(found.len(), count);
            for place in &PLACES[..count] {
                let figure = &found[nearest(&found, DVec2::from(*place)).unwrap()];
                // The arm and the leg move the middle of what is seen.
                assert!(figure.place.distance(DVec2::from(*place)) < 120.0, "{figure:?}");
                assert!((figure.height - 1700.0).abs() < 150.0, "{}", figure.height);
            }
        }
        let nobody: Vec<Observation> = cameras.iter().map(|c| Observation::empty(c.size[0], c.size[1])).collect();
        assert!(figures(&cameras, &SeenView::all(&nobody)).is_empty());
    }

    #[test]
    fn what_shows_others_is_told_and_what_shows_oneself_stays() {
        let cameras = cameras_around();
        let alone = PLACES.map(|place| seen_at(place, &cameras));
        let observations = together(&alone);
        let views = SeenView::all(&observations);
        let found = figures(&cameras, &views);
        for own in 0..found.len() {
            let ignored = others(&cameras, &views, &found, own);
            let [mut his, mut kept, mut foreign, mut told] = [0_u32; 4];
            for (view, ignored) in ignored.into_iter().enumerate() {
                let ignored = ignored.unwrap();
                let of = |who: usize| alone[who][view].silhouette();
                let own =
                    (0..PLACES.len()).min_by_key(|who| found[own].place.distance(PLACES[*who].into()) as u64).unwrap();
                let count = |image: &BitImage| {
                    let mut left = image.clone();
                    left.and_not(&ignored);
                    (image.count(), left.count())
                };
                let (all, left) = count(&of(own));
                (his, kept) = (his + all, kept + left);
                let mut strangers = BitImage::new(ignored.width(), ignored.height());
                (0..PLACES.len()).filter(|who| *who != own).for_each(|who| strangers.or(&of(who)));
                strangers.and_not(&of(own));
                let (all, left) = count(&strangers);
                (foreign, told) = (foreign + all, told + all - left);
            }
            println!("person {own}: {kept} of {his} pixels stay, {told} of {foreign} of others are told");
            assert!(f64::from(kept) > 0.97 * f64::from(his) && f64::from(told) > 0.85 * f64::from(foreign));
        }
    }
}
