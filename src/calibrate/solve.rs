//! One camera from its pairs: linear start, Levenberg-Marquardt, outliers, and what the result is worth (METHOD A2).

use anyhow::{Context, Result, bail, ensure};
use glam::{DVec2, DVec3};
use nalgebra::DMatrix;

use super::layout::{Layout, Placement};
use super::linear::{Failure, Start, radial_alignment};
use super::pairs::{CameraPairs, Pair};
use super::parameters::{Held, LensModel, Parameters, middle};
use super::refine::Reprojection;
use super::residuals::{Residual, robust_deviation};
use crate::geometry::{Camera, rodrigues_vector};

/// A pair farther off than this many standard deviations of one coordinate is an outlier: of a million good pairs forty are.
const OUTLIER: f64 = 4.5;
/// Nobody measures a pixel better than this: nearer pairs are never outliers.
const FINEST: f64 = 0.01;
/// Subsets of the pairs that starts are made from, so that one holds no outlier.
const SUBSETS: usize = 120;
/// Below this ratio of singular values some combination of parameters changes nothing in the pictures.
const OBSERVABLE: f64 = 1e-7;
/// A camera farther off than this part of the picture's diagonal is none of these pairs.
const ASTRAY: f64 = 0.03;

/// What to calibrate and how.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationSettings {
    /// The lens.
    pub model: LensModel,
    /// How the points lie; None: see for yourself.
    pub layout: Option<Layout>,
    /// What is not estimated; None: for points in a plane the aspect, the centre, the tangential terms and k3, else k3.
    pub held: Option<Vec<Held>>,
    /// Side of a pixel, mm: only gives f and kappa of Tsai's model their unit.
    pub pitch: f64,
    /// Whether all pairs are used, whatever their residuals.
    pub keep_outliers: bool,
}

impl Default for CalibrationSettings {
    fn default() -> Self {
        Self { model: LensModel::Tsai, layout: None, held: None, pitch: 0.01, keep_outliers: false }
    }
}

/// A parameter of a calibrated camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Its name: rx ry rz (Rodrigues vector, radians), tx ty tz (mm), then the lens's.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation: the Cramer-Rao bound for the noise that the residuals show. For rx ry rz that of a turn
    /// about the camera's own axes. None where it was held.
    pub deviation: Option<f64>,
}

/// A calibrated camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The camera.
    pub camera: Camera,
    /// How its points lie.
    pub layout: Layout,
    /// A residual a pair, in the order of the pairs.
    pub residuals: Vec<Residual>,
    /// Its parameters.
    pub estimates: Vec<Estimate>,
    /// Standard deviation of a coordinate, pixels, the parameters' own share taken off.
    pub noise: f64,
}

/// Calibrates one camera with pictures of `size`.
///
/// # Errors
/// One sentence that begins with the camera and says why its points do not determine it: too few, on a line, in a plane
/// where they should not be, parallel to the picture, mirrored, behind the camera, or contradicting each other.
pub fn calibrate(pairs: &CameraPairs, size: [u32; 2], settings: &CalibrationSettings) -> Result<Calibration> {
    check_within(&pairs.pairs, size)
        .and_then(|()| Problem::new(pairs, size, settings))
        .and_then(|problem| problem.solve())
        .with_context(|| format!("camera `{}`", pairs.camera))
}

/// Refuses pairs of which more than a few, as wrong ones are, lie outside the picture.
fn check_within(pairs: &[Pair], size: [u32; 2]) -> Result<()> {
    let beyond = |pair: &Pair| {
        let [width, height] = size.map(f64::from);
        let (last, at) = (DVec2::new(width, height) - 0.5, pair.pixel);
        (DVec2::splat(-0.5) - at).max(at - last).max_element()
    };
    let outside = pairs.iter().filter(|pair| beyond(pair) > 1.0).count();
    let farthest = pairs.iter().max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
    if let Some(farthest) = farthest.filter(|_| outside * 10 > pairs.len()) {
        bail!(
            "{outside} of {} points lie outside its pictures of {}x{} pixels, {} at ({:.1}, {:.1}): is that their size?",
            pairs.len(),
            size[0],
            size[1],
            farthest.name,
            farthest.pixel.x,
            farthest.pixel.y
        );
    }
    Ok(())
}

struct Problem<'a> {
    camera: &'a str,
    pairs: &'a [Pair],
    size: [u32; 2],
    settings: &'a CalibrationSettings,
    placement: Placement,
    free: Vec<usize>,
}

impl<'a> Problem<'a> {
    fn new(pairs: &'a CameraPairs, size: [u32; 2], settings: &'a CalibrationSettings) -> Result<Self> {
        let placement = Placement::of(&pairs.pairs, settings.layout)?;
        let usual = match placement.layout {
            Layout::Coplanar => &[Held::Aspect, Held::Centre, Held::Tangential, Held::K3][..],
            Layout::General => &[Held::K3],
        };
        let held = settings.held.as_deref().unwrap_or(usual);
        ensure!(
            placement.layout == Layout::General || held.contains(&Held::Aspect),
            "the points lie in a plane, from which s_x cannot be told: hold the aspect"
        );
        let free = Parameters::free(settings.model, held);
        ensure!(
            2 * pairs.pairs.len() > free.len(),
            "{} pairs are too few for {} parameters, expected at least {}: hold some of them, or give more points",
            pairs.pairs.len(),
            free.len(),
            free.len() / 2 + 1
        );
        Ok(Self { camera: &pairs.camera, pairs: &pairs.pairs, size, settings, placement, free })
    }

    fn solve(&self) -> Result<Calibration> {
        let (parameters, used) = self.fit(self.pairs, self.start(self.pairs))?;
        let lengths = lengths(&parameters, self.pairs);
        let deviation = robust_deviation(&lengths);
        self.refuse_mirrored(deviation)?;
        let [width, height] = self.size.map(f64::from);
        ensure!(
            deviation <= ASTRAY * width.hypot(height),
            "the pairs contradict each other: the best camera is {deviation:.0} pixels off; check which pixel belongs to which \
             point, and the units"
        );
        let behind =
            self.pairs.iter().zip(&lengths).zip(&used).filter(|((_, length), used)| **used && length.is_infinite());
        if let Some(((pair, _), _)) = behind.into_iter().next() {
            bail!("{} lies behind the camera found, or outside what its lens can map", pair.name);
        }
        let left_out = used.iter().filter(|used| !**used).count();
        ensure!(
            3 * left_out <= self.pairs.len(),
            "{left_out} of {} pairs contradict the others: check which pixel belongs to which point, and the units",
            self.pairs.len()
        );
        self.judge(parameters, &used)
    }

    /// Fits the pairs from a start; with it, which of the pairs were used.
    fn fit(&self, pairs: &[Pair], start: Result<Parameters, Failure>) -> Result<(Parameters, Vec<bool>)> {
        let mut parameters = start.map_err(|failure| self.reason(failure))?;
        // With hardly more equations than parameters any residual can be fitted away: outliers do not show.
        let keeps_all = self.settings.keep_outliers || 2 * pairs.len() < 2 * self.free.len();
        let all = vec![true; pairs.len()];
        let mut used = if keeps_all { all.clone() } else { self.near(&parameters, pairs) };
        for _ in 0..20 {
            let chosen = pairs.iter().zip(&used).filter(|(_, used)| **used).map(|(pair, _)| pair).collect();
            parameters = Reprojection { parameters, free: &self.free, pairs: chosen }.minimise();
            let near = if keeps_all { all.clone() } else { self.near(&parameters, pairs) };
            if near == used {
                break;
            }
            used = near;
        }
        Ok((parameters, used))
    }

    /// Which pairs are no outliers.
    fn near(&self, parameters: &Parameters, pairs: &[Pair]) -> Vec<bool> {
        let lengths = lengths(parameters, pairs);
        let (equations, unknowns) = (2.0 * pairs.len() as f64, self.free.len() as f64);
        // The fit takes its share of the noise away.
        let share = (equations / (equations - unknowns)).sqrt();
        let limit = (OUTLIER * robust_deviation(&lengths) * share).max(FINEST);
        let near: Vec<bool> = lengths.iter().map(|length| *length <= limit).collect();
        // Never so few that the rest could not be determined.
        let kept = near.iter().filter(|near| **near).count();
        if 2 * kept > self.free.len() && kept >= self.placement.layout.fewest() { near } else { vec![true; near.len()] }
    }

    /// The best of the linear starts of all pairs and of subsets.
    fn start(&self, pairs: &[Pair]) -> Result<Parameters, Failure> {
        let everything: Vec<usize> = (0..pairs.len()).collect();
        let mut candidates = vec![self.linear(pairs, &everything, None)];
        // Noise tilts the plane of one subset or another.
        if matches!(candidates[0], Err(Failure::Parallel)) {
            return Err(Failure::Parallel);
        }
        let wanted = self.placement.layout.fewest() + 3;
        if pairs.len() > wanted {
            let mut random = Shuffle(1);
            candidates.extend((0..SUBSETS).map(|_| self.linear(pairs, &random.choose(pairs.len(), wanted), None)));
        }
        if candidates.iter().all(Result::is_err) {
            // Little perspective leaves the focal length open: some that lenses have.
            let [width, height] = self.size.map(f64::from);
            let guesses = [0.5, 0.8, 1.2, 2.0, 4.0].map(|factor| factor * width.max(height));
            candidates.extend(guesses.map(|focal| self.linear(pairs, &everything, Some(focal))));
        }
        let failure = candidates[0].as_ref().err().copied().unwrap_or(Failure::Behind);
        let scored = candidates.into_iter().flatten().map(|parameters| {
            let deviation = robust_deviation(&lengths(&parameters, pairs));
            (deviation, parameters)
        });
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, parameters)| parameters).ok_or(failure)
    }

    fn linear(&self, pairs: &[Pair], chosen: &[usize], focal: Option<f64>) -> Result<Parameters, Failure> {
        let local = &self.placement.local_from_world;
        let centre = middle(self.size);
        let points: Vec<DVec3> = chosen.iter().map(|&at| local.transform_point3(pairs[at].point)).collect();
        let offsets: Vec<DVec2> = chosen.iter().map(|&at| pairs[at].pixel - centre).collect();
        let Start { camera_from_local, focal, aspect } =
            radial_alignment(self.placement.layout, &points, &offsets, focal)?;
        let is_held =
            !self.free.iter().any(|&at| matches!(Parameters::names(self.settings.model)[at], "s_x" | "fx/fy"));
        let aspect = if is_held { 1.0 } else { aspect };
        let pose = camera_from_local * *local;
        Ok(Parameters::new(self.settings.model, self.size, self.settings.pitch, pose, focal, aspect))
    }

    /// Where the pairs hardly fit, do they fit with the picture turned over? A plane seen from either side fits both ways.
    fn refuse_mirrored(&self, deviation: f64) -> Result<()> {
        if deviation < 1.0 || self.placement.layout == Layout::Coplanar {
            return Ok(());
        }
        let mirror = |pair: &Pair| {
            let pixel = DVec2::new(f64::from(self.size[0]) - 1.0 - pair.pixel.x, pair.pixel.y);
            Pair { pixel, ..pair.clone() }
        };
        let mirrored: Vec<Pair> = self.pairs.iter().map(mirror).collect();
        let Ok((parameters, _)) = self.fit(&mirrored, self.start(&mirrored)) else { return Ok(()) };
        let turned = robust_deviation(&lengths(&parameters, &mirrored));
        ensure!(
            3.0 * turned > deviation,
            "the points are mirrored: they fit within {turned:.2} pixels with the picture turned over, and within \
             {deviation:.0} as it is; expected a right-handed world, u to the right and v down"
        );
        Ok(())
    }

    fn reason(&self, failure: Failure) -> anyhow::Error {
        match failure {
            Failure::Undetermined => anyhow::anyhow!(
                "the pairs do not determine where the camera looks: their points or pixels lie in too special a way, \
                 expected them spread over the picture and the volume"
            ),
            Failure::Parallel => anyhow::anyhow!(
                "the plane of the points is parallel to the picture within 10 degrees, where focal length and distance \
                 cannot be told apart, expected it tilted by 20 degrees or more"
            ),
            Failure::Behind => anyhow::anyhow!(
                "points come out behind the camera: they are mirrored (expected a right-handed world, u to the right, v \
                 down), or pixels and points do not belong together"
            ),
        }
    }

    /// What the parameters are worth.
    fn judge(&self, parameters: Parameters, used: &[bool]) -> Result<Calibration> {
        let camera = parameters.camera(self.camera);
        let residuals: Vec<Residual> = self
            .pairs
            .iter()
            .zip(used)
            .map(|(pair, used)| Residual {
                name: pair.name.clone(),
                pixel: pair.pixel,
                offset: camera.project(pair.point).map(|pixel| pair.pixel - pixel),
                is_outlier: !used,
            })
            .collect();
        let chosen: Vec<&Pair> = self.pairs.iter().zip(used).filter(|(_, used)| **used).map(|(pair, _)| pair).collect();
        let squares: f64 = residuals.iter().filter(|r| !r.is_outlier).map(|r| r.length().powi(2)).sum();
        let spare = (2 * chosen.len()).saturating_sub(self.free.len()).max(1) as f64;
        let noise = (squares / spare).sqrt();
        let names = Parameters::names(self.settings.model);
        let derivative = Reprojection { parameters: parameters.clone(), free: &self.free, pairs: chosen }.derivative();
        let unit = unit_deviations(derivative, &self.free.iter().map(|&at| names[at]).collect::<Vec<_>>())?;
        let turn = rodrigues_vector(camera.camera_from_world.matrix3).to_array();
        let estimate = |(at, &name): (usize, &&'static str)| Estimate {
            name,
            value: if at < 3 { turn[at] } else { parameters.values[at] },
            deviation: self.free.iter().position(|&free| free == at).map(|place| noise * unit[place]),
        };
        let estimates: Vec<Estimate> = names.iter().enumerate().map(estimate).collect();
        if let Some(f) = estimates.iter().find(|estimate| matches!(estimate.name, "f" | "fy")) {
            ensure!(
                f.value > 0.0,
                "the focal length comes out as {:.3}, expected more than 0: the pairs do not fit a camera",
                f.value
            );
        }
        Ok(Calibration { camera, layout: self.placement.layout, residuals, estimates, noise })
    }
}

/// The parameters' standard deviations for a noise of one pixel: roots of the diagonal of (J^T J)^-1, the Cramer-Rao bound.
///
/// # Errors
/// When a combination of parameters leaves all pixels where they are.
pub(super) fn unit_deviations(mut derivative: DMatrix<f64>, names: &[&str]) -> Result<Vec<f64>> {
    let lengths: Vec<f64> = derivative.column_iter().map(|column| column.norm()).collect();
    ensure!(lengths.iter().all(|length| length.is_finite()), "the pairs do not fit a camera");
    for (mut column, length) in derivative.column_iter_mut().zip(&lengths) {
        column /= length.max(f64::MIN_POSITIVE);
    }
    let svd = derivative.svd(false, true);
    let Some(directions) = &svd.v_t else { bail!("the parameters' deviations cannot be computed") };
    let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
    if smallest.is_nan() || smallest <= OBSERVABLE * largest {
        let weakest = directions.row(svd.singular_values.imin());
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by(|&a, &b| weakest[b].abs().total_cmp(&weakest[a].abs()));
        let together: Vec<&str> = order.iter().take(3).map(|&at| names[at]).collect();
        bail!(
            "the points do not determine {}: changed together they move no pixel; spread the points in depth and over the \
             picture, or hold one of them",
            together.join(", ")
        );
    }
    let variance = |at: usize| {
        let rows = directions.column(at);
        rows.iter().zip(&svd.singular_values).map(|(v, s)| (v / s).powi(2)).sum::<f64>()
    };
    Ok(lengths.iter().enumerate().map(|(at, length)| variance(at).sqrt() / length).collect())
}

/// How far each pair is off, pixels.
fn lengths(parameters: &Parameters, pairs: &[Pair]) -> Vec<f64> {
    let camera = parameters.camera("");
    let length = |pair: &Pair| camera.project(pair.point).map_or(f64::INFINITY, |pixel| pixel.distance(pair.pixel));
    pairs.iter().map(length).collect()
}

/// Subsets drawn the same way on every run (a linear congruence is random enough for that).
struct Shuffle(u64);

impl Shuffle {
    fn choose(&mut self, count: usize, wanted: usize) -> Vec<usize> {
        let mut places: Vec<usize> = (0..count).collect();
        for at in 0..wanted {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let other = at + (self.0 >> 33) as usize % (count - at);
            places.swap(at, other);
        }
        places.truncate(wanted);
        places
    }
}

#[cfg(test)]
#[path = "solve_tests.rs"]
mod tests;
