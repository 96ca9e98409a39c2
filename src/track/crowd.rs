//! Who of several people shows at each pixel, and what that leaves for one of them to be compared with (METHOD A8).

use std::sync::Arc;

use anyhow::{Result, ensure};
use rayon::prelude::*;

use super::feed::Prepared;
use crate::body::Body;
use crate::evaluate::{PartQuad, Projector, draw_quads};
use crate::features::morphology::{Element, Morphology};
use crate::features::{BitImage, FeatureSettings, Ignoring, Shape};
use crate::geometry::Camera;
use crate::observe::take_observations;

/// How far round another person's drawn silhouette her pixels may still show, in shares of the picture's height: bodies are drawn
/// without hair and folds.
const RIM: f64 = 0.008;

/// The people of a run, drawn together.
pub(super) struct Crowd {
    projectors: Vec<Projector>,
    sizes: Vec<[u32; 2]>,
    ignoring: Ignoring,
}

/// A number a pixel for each view: 0 where nobody shows, k + 1 where person k does.
pub(super) struct Owners(Vec<Vec<u8>>);

impl Crowd {
    /// Of people with these bodies before the same cameras.
    ///
    /// # Errors
    /// When there are more than a byte tells apart.
    pub(super) fn new(bodies: &[&Body], cameras: &[Camera], settings: &FeatureSettings) -> Result<Self> {
        ensure!(bodies.len() <= 127, "{} people are to be tracked together, expected at most 127", bodies.len());
        Ok(Self {
            projectors: bodies.iter().map(|body| Projector::new(body, cameras)).collect(),
            sizes: cameras.iter().map(|camera| camera.size).collect(),
            ignoring: Ignoring::new(settings),
        })
    }

    /// Who shows where with these poses, one a person; none of one who is lost, who hides nobody.
    pub(super) fn owners(&self, poses: &[Option<Vec<f32>>]) -> Owners {
        let view = |(view, &[width, height]): (usize, &[u32; 2])| {
            let (mut quads, mut labels): (Vec<PartQuad>, Vec<u8>) = (Vec::new(), Vec::new());
            for (label, (projector, pose)) in (1..).zip(self.projectors.iter().zip(poses)) {
                let Some(pose) = pose else { continue };
                quads.extend(projector.quads(pose, view));
                labels.resize(quads.len(), label);
            }
            let mut bytes = draw_quads(&quads, &labels, width, height).bytes;
            bytes.iter_mut().for_each(|byte| *byte &= 0x7f);
            bytes
        };
        Owners(self.sizes.par_iter().enumerate().map(view).collect())
    }

    /// A frame as person `person` is compared with it: what shows others counts neither for nor against her.
    ///
    /// # Errors
    /// When features are of another size than they say.
    pub(super) fn share(&self, prepared: &mut Prepared, owners: &Owners, person: usize) -> Result<()> {
        let mut features = prepared.features_kept.clone();
        self.ignoring.apply(&mut features, &self.others(owners, person))?;
        prepared.observations = take_observations(&mut features);
        Ok(())
    }

    /// For each view the pixels of others than person `person`, and those just round them that are not her own.
    pub(super) fn others(&self, owners: &Owners, person: usize) -> Vec<Option<Arc<BitImage>>> {
        let own = person as u8 + 1;
        let view = |(&[width, height], owners): (&[u32; 2], &Vec<u8>)| {
            let owner = |x: u32, y: u32| owners[y as usize * width as usize + x as usize];
            let mut others = BitImage::from_fn(width, height, |x, y| !matches!(owner(x, y), 0) && owner(x, y) != own);
            let radius = (RIM * f64::from(height)).ceil() as u32;
            Morphology::default().dilate(&mut others, Element { shape: Shape::Disc, radius });
            others.and_not(&BitImage::from_fn(width, height, |x, y| owner(x, y) == own));
            Some(Arc::new(others))
        };
        self.sizes.par_iter().zip(&owners.0).map(view).collect()
    }
}
