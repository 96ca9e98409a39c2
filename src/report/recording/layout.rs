//! How the viewer's windows are laid out: space and the cameras above, curves, bars and texts below.

use anyhow::Result;
use re_chunk::{EntityPath, TimePoint};
use re_log_types::TimeCell;
use re_sdk_types::AsComponents;
use re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
};
use re_sdk_types::blueprint::components::ContainerKind;
use re_sdk_types::external::uuid::Uuid;

use super::stream::{Stream, entity};

/// What windows there are.
pub(super) struct Windows {
    /// Names of the cameras and their entities.
    pub(super) cameras: Vec<(String, EntityPath)>,
    /// Plots: the viewer's class, the heading, and what under `/plots`.
    pub(super) plots: Vec<[&'static str; 3]>,
}

/// Writes the layout into the store at hand and turns it on; the viewer then plays along `timeline`.
pub(super) fn write_layout(stream: &mut Stream, windows: &Windows, timeline: &str) -> Result<()> {
    let mut layout = Layout { stream };
    let space = layout.view("3D", "Motion in space", &entity(&["world"]))?;
    let cameras = windows.cameras.iter().map(|(name, path)| layout.view("2D", name, path));
    let cameras = cameras.collect::<Result<Vec<_>>>()?;
    let mut above = vec![space];
    if !cameras.is_empty() {
        above.push(layout.container(ContainerKind::Grid, "The model over the pictures", &cameras, &[])?.path());
    }
    let above = layout.container(ContainerKind::Horizontal, "Above", &above, &[])?;
    let plots = windows.plots.iter().map(|[class, name, plot]| layout.view(class, name, &entity(&["plots", plot])));
    let mut below = plots.collect::<Result<Vec<_>>>()?;
    let texts = [("Summary", "summary"), ("Settings", "settings")];
    let texts = texts.map(|(name, text)| layout.view("TextDocument", name, &entity(&["report", text])));
    let texts = texts.into_iter().collect::<Result<Vec<_>>>()?;
    below.push(layout.container(ContainerKind::Tabs, "Texts", &texts, &[])?.path());
    let below = layout.container(ContainerKind::Horizontal, "Below", &below, &[])?;
    let root = layout.container(ContainerKind::Vertical, "Report", &[above.path(), below.path()], &[1.6, 1.0])?;
    let viewport = ViewportBlueprint::new().with_root_container(root.id).with_auto_layout(false).with_auto_views(false);
    layout.put(&"viewport".into(), &viewport)?;
    layout.put(&"time_panel".into(), &TimePanelBlueprint::new().with_timeline(timeline))?;
    stream.activate()
}

struct Layout<'s, 'w> {
    stream: &'s mut Stream<'w>,
}

/// A container of windows.
struct Container {
    id: Uuid,
}

impl Container {
    fn path(&self) -> EntityPath {
        entity(&["container", &self.id.to_string()])
    }
}

impl Layout<'_, '_> {
    fn put(&mut self, path: &EntityPath, what: &dyn AsComponents) -> Result<()> {
        // The viewer asks for a layout's state at this moment of this time-line.
        let now = TimePoint::default().with_index("blueprint", TimeCell::from_sequence(0_i64));
        self.stream.rows(path, [(now, [what])])
    }

    /// A window on an entity and all below it.
    fn view(&mut self, class: &str, name: &str, origin: &EntityPath) -> Result<EntityPath> {
        let id = Uuid::new_v4().to_string();
        self.put(&entity(&["view", &id, "ViewContents"]), &ViewContents::new(["$origin/**"]))?;
        let path = entity(&["view", &id]);
        self.put(&path, &ViewBlueprint::new(class).with_display_name(name).with_space_origin(origin.to_string()))?;
        Ok(path)
    }

    /// Windows and containers side by side, one above the other, in a grid or behind each other.
    fn container(
        &mut self,
        kind: ContainerKind,
        name: &str,
        contents: &[EntityPath],
        row_shares: &[f32],
    ) -> Result<Container> {
        let container = Container { id: Uuid::new_v4() };
        let contents = contents.iter().map(EntityPath::to_string);
        let mut what = ContainerBlueprint::new(kind).with_display_name(name).with_contents(contents);
        if !row_shares.is_empty() {
            what = what.with_row_shares(row_shares.iter().copied());
        }
        self.put(&container.path(), &what)?;
        Ok(container)
    }
}
