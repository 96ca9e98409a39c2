//! The passes of a frame on the device, in order.

use anyhow::Result;

use super::view::{DeviceView, Plane, copy_whole};
use crate::features::FeatureSettings;
use crate::features::stages::{
    BoundsStage, BridgeStage, ComponentsStages, DifferenceStage, DistanceStage, EdgesStage, Keep, MixtureStages,
    MorphologyStage, Operation, PackStage, RATIO_STEPS, RatiosStages, ReachStage, SmoothStage,
};
use crate::gpu::{Device, Recorder};

/// Every stage, compiled for one set of settings.
#[derive(Debug)]
pub(super) struct Passes {
    ratios: RatiosStages,
    difference: DifferenceStage,
    mixture: MixtureStages,
    morphology: MorphologyStage,
    touched: ComponentsStages,
    bridge: BridgeStage,
    largest: ComponentsStages,
    holes: ComponentsStages,
    bounds: BoundsStage,
    smooth: SmoothStage,
    edges: EdgesStage,
    reach: ReachStage,
    distance: DistanceStage,
    pack: PackStage,
}

impl Passes {
    /// Compiles them; `proximity` is the table of the settings.
    pub(super) fn new(device: &Device, settings: &FeatureSettings, proximity: &[u8]) -> Result<Self> {
        Ok(Self {
            ratios: RatiosStages::new(device)?,
            difference: DifferenceStage::new(device)?,
            mixture: MixtureStages::new(device, &settings.mixture)?,
            morphology: MorphologyStage::new(device)?,
            touched: ComponentsStages::new(device, Keep::Touched)?,
            bridge: BridgeStage::new(device)?,
            largest: ComponentsStages::new(device, Keep::largest(&settings.silhouette))?,
            holes: ComponentsStages::new(device, Keep::Holes(settings.silhouette.max_hole))?,
            bounds: BoundsStage::new(device)?,
            smooth: SmoothStage::new(device, settings.edges.smooth)?,
            edges: EdgesStage::new(device, &settings.edges)?,
            reach: ReachStage::new(device)?,
            distance: DistanceStage::new(device, settings.distance.metric)?,
            pack: PackStage::new(device, proximity)?,
        })
    }

    /// Records a frame: `masked` says which views bring their silhouette with them.
    pub(super) fn record_frame(
        &self,
        recorder: &mut Recorder,
        views: &[DeviceView],
        masked: &[bool],
        settings: &FeatureSettings,
    ) -> Result<()> {
        let all: Vec<&DeviceView> = views.iter().collect();
        let of = |wanted: &dyn Fn(&DeviceView, bool) -> bool| -> Vec<&DeviceView> {
            views.iter().zip(masked).filter(|&(view, &masked)| wanted(view, masked)).map(|(view, _)| view).collect()
        };
        let with_mask = of(&|_, masked| masked);
        let segmented = of(&|_, masked| !masked);
        let with_plate = of(&|view, masked| !masked && view.plate().is_some());
        let with_mixture = of(&|view, masked| !masked && view.plate().is_none());
        for view in views {
            copy_whole(recorder, "upload", &view.colours_in, &view.colours)?;
        }
        for view in &with_mask {
            copy_whole(recorder, "upload", &view.mask_in, view.plane(Plane::Silhouette))?;
        }
        if !with_plate.is_empty() {
            self.record_difference(recorder, &with_plate, settings)?;
        }
        if !with_mixture.is_empty() {
            self.record_mixture(recorder, &with_mixture, settings)?;
        }
        if !segmented.is_empty() {
            self.record_cleaning(recorder, &segmented, &with_plate, settings)?;
        }
        self.bounds.record(recorder, &all, Plane::Silhouette)?;
        self.smooth.record(recorder, &all)?;
        let near = [Plane::Silhouette, Plane::Near];
        self.morphology.record(recorder, &all, Operation::Dilate, settings.dilation(), near)?;
        self.edges.record(recorder, &all)?;
        self.reach.record(recorder, &all)?;
        self.distance.record(recorder, &all)?;
        self.pack.record(recorder, &all)?;
        for view in &segmented {
            copy_whole(recorder, "readback", view.plane(Plane::Foreground), &view.foreground_out)?;
            copy_whole(recorder, "readback", view.plane(Plane::Silhouette), &view.silhouette_out)?;
        }
        for view in views {
            copy_whole(recorder, "readback", &view.sides, &view.sides_out)?;
            copy_whole(recorder, "readback", view.plane(Plane::Edges), &view.edges_out)?;
            copy_whole(recorder, "readback", &view.codes, &view.codes_out)?;
            copy_whole(recorder, "readback", &view.packed, &view.packed_out)?;
        }
        Ok(())
    }

    /// Records what views without a plate learn from a frame of the empty scene.
    pub(super) fn record_priming(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        settings: &FeatureSettings,
    ) -> Result<()> {
        for view in views {
            copy_whole(recorder, "upload", &view.colours_in, &view.colours)?;
        }
        self.record_mixture(recorder, views, settings)
    }

    fn record_difference(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        settings: &FeatureSettings,
    ) -> Result<()> {
        if settings.plate.gain {
            self.ratios.record(recorder, views)?;
        } else {
            views.iter().try_for_each(|view| recorder.fill("gain", &view.light.gains, RATIO_STEPS))?;
        }
        self.difference.record(recorder, views, &settings.plate, &settings.shadow)
    }

    fn record_mixture(&self, recorder: &mut Recorder, views: &[&DeviceView], settings: &FeatureSettings) -> Result<()> {
        if settings.mixture.gain {
            self.mixture.record_probable(recorder, views)?;
            self.ratios.record(recorder, views)?;
        }
        self.mixture.record(recorder, views, &settings.mixture, &settings.shadow)
    }

    /// From foreground to silhouette; those with a plate have their hysteresis and bridges.
    fn record_cleaning(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        with_plate: &[&DeviceView],
        settings: &FeatureSettings,
    ) -> Result<()> {
        use Plane::{Foreground, Silhouette, Strong, WorkA, WorkB, WorkC};
        let morphology = &self.morphology;
        morphology.record_opening(recorder, views, settings.opening(), [Foreground, WorkA, WorkB])?;
        if !with_plate.is_empty() {
            self.touched.record(recorder, with_plate, Strong, [WorkB, WorkA])?;
            morphology.record_closing(recorder, with_plate, settings.bridge(), [WorkA, WorkB, WorkC])?;
            self.bridge.record(recorder, with_plate, [WorkA, WorkC, WorkB])?;
        }
        morphology.record_closing(recorder, views, settings.closing(), [WorkB, WorkA, WorkC])?;
        self.largest.record(recorder, views, Strong, [WorkC, WorkA])?;
        self.holes.record(recorder, views, Strong, [WorkA, Silhouette])
    }
}
