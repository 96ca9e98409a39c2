//! What stays of a manifest that is made anew: all that its user wrote or changed.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use toml::{Table, Value};

use crate::files::{file_stem, listed, read_toml};
use crate::geometry::Camera;
use crate::sequence::Orientation;

/// Keys that are written anew.
const OWN: [&str; 9] = ["name", "fps", "cameras", "body", "start", "height", "scale", "person", "view"];
/// The same of a view.
const OWN_OF_VIEW: [&str; 4] = ["camera", "source", "background", "background_doubtful"];

/// What is kept.
#[derive(Debug, Default)]
pub(super) struct Kept {
    pub(super) name: Option<String>,
    pub(super) fps: Option<f64>,
    pub(super) scale: Option<f64>,
    /// Keys and tables of the whole sequence.
    pub(super) whole: Table,
    views: Vec<KeptView>,
}

/// What is kept of a view.
#[derive(Debug)]
struct KeptView {
    camera: String,
    keys: Table,
    /// A plate that was not learnt: its file as the manifest names it, and how much of it is doubtful.
    plate: Option<(PathBuf, f64)>,
}

impl Kept {
    /// Of a manifest, which will have so many people.
    ///
    /// # Errors
    /// When it is no TOML, or has several people where there will be one.
    pub(super) fn read(manifest: &Path, people: usize) -> Result<Self> {
        let mut table: Table = read_toml(manifest)?;
        ensure!(
            people > 1 || !table.contains_key("person"),
            "{} has [[person]], and one person is measured here, expected a manifest of one person, --people or another folder (-o)",
            manifest.display()
        );
        let number = |value: Option<&Value>| {
            value.and_then(|value| value.as_float().or(value.as_integer().map(|whole| whole as f64)))
        };
        let mut kept = Self {
            name: table.get("name").and_then(Value::as_str).map(str::to_string),
            fps: number(table.get("fps")),
            scale: number(table.get("scale")),
            ..Self::default()
        };
        let views = table.get("view").and_then(Value::as_array).cloned().unwrap_or_default();
        for view in views {
            let Value::Table(mut keys) = view else { continue };
            let Some(camera) = keys.get("camera").and_then(Value::as_str).map(str::to_string) else { continue };
            let doubtful = number(keys.get("background_doubtful")).unwrap_or(0.0);
            let plate = keys.get("background").and_then(Value::as_str).filter(|file| *file != learnt_plate(&camera));
            let plate = plate.map(|file| (PathBuf::from(file), doubtful));
            keys.retain(|key, _| !OWN_OF_VIEW.contains(&key));
            kept.views.push(KeptView { camera, keys, plate });
        }
        table.retain(|key, value| !OWN.contains(&key) && !is_usual(key, value));
        kept.whole = table;
        Ok(kept)
    }

    /// With the orientations that are asked for.
    ///
    /// # Errors
    /// When one is of no camera.
    pub(super) fn oriented(mut self, orientations: &[(String, Orientation)], cameras: &[Camera]) -> Result<Self> {
        for (camera, orientation) in orientations {
            if !cameras.iter().any(|known| known.name == *camera) {
                let names = cameras.iter().map(|camera| camera.name.as_str());
                bail!("--orientation names camera {camera:?}, expected one of {}", listed(names));
            }
            let value = orientation.value();
            match self.views.iter_mut().find(|view| view.camera == *camera) {
                Some(view) => drop(view.keys.insert("orientation".to_string(), value)),
                None => {
                    let keys = Table::from_iter([("orientation".to_string(), value)]);
                    self.views.push(KeptView { camera: camera.clone(), keys, plate: None });
                }
            }
        }
        Ok(self)
    }

    fn view(&self, camera: &str) -> Option<&KeptView> {
        self.views.iter().find(|view| view.camera == camera)
    }

    /// The keys of a view.
    pub(super) fn keys(&self, camera: &str) -> Option<&Table> {
        self.view(camera).map(|view| &view.keys)
    }

    /// A view's plate, seen from `folder`, and how much of it is doubtful, where its manifest names one that was not learnt here.
    pub(super) fn plate(&self, camera: &str, folder: &Path) -> Option<(PathBuf, f64)> {
        let (file, doubtful) = self.view(camera)?.plate.as_ref()?;
        Some((folder.join(file), *doubtful))
    }

    /// How a view's pictures are turned.
    ///
    /// # Errors
    /// When that is no orientation.
    pub(super) fn orientation(&self, camera: &str) -> Result<Option<Orientation>> {
        let value = self.keys(camera).and_then(|keys| keys.get("orientation"));
        let name = value.map(|value| value.as_str().map_or_else(|| value.to_string(), str::to_string));
        name.map(|name| Orientation::from_name(&name)).transpose()
    }

    /// Whether backgrounds are learnt as the frames go by.
    pub(super) fn learns_on(&self) -> bool {
        self.whole.get("features").and_then(Value::as_table).is_some_and(|features| features.contains_key("mixture"))
    }

    /// A sentence on what is kept for the views of `cameras`, `more` besides; none where that is nothing.
    pub(super) fn remark(&self, cameras: &[Camera], more: &[String]) -> Option<String> {
        let mut named: Vec<String> = more.to_vec();
        named.extend(
            self.whole
                .iter()
                .map(|(key, value)| if value.is_table() { format!("[{key}]") } else { format!("`{key}`") }),
        );
        for camera in cameras {
            let Some(view) = self.view(&camera.name) else { continue };
            let mut keys: Vec<String> = view.keys.keys().map(|key| format!("`{key}`")).collect();
            keys.extend(view.plate.as_ref().map(|_| "`background`".to_string()));
            if !keys.is_empty() {
                named.push(format!("{} of camera {:?}", keys.join(" and "), camera.name));
            }
        }
        let gone: Vec<&str> = self
            .views
            .iter()
            .map(|view| view.camera.as_str())
            .filter(|name| !cameras.iter().any(|camera| camera.name == *name))
            .collect();
        if !gone.is_empty() {
            named.push(format!("not the views of {}, of which no video is given", listed(&gone)));
        }
        (!named.is_empty()).then(|| {
            format!(
                "kept from the manifest that was there: {}; what is not wanted any more is to be taken out of it",
                named.join(", ")
            )
        })
    }
}

/// Whether a key says what is written where it is missing.
fn is_usual(key: &str, value: &Value) -> bool {
    key == "measure_again" && value.as_bool() == Some(true)
}

/// The name of a camera's plate that is learnt, seen from the manifest.
pub(super) fn learnt_plate(camera: &str) -> String {
    format!("plates/{}.png", file_stem(camera))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of a manifest's `whole` keys and those of its only `view`, whose camera is there.
    fn remark(whole: &str, view: &str) -> Option<String> {
        let folder = tempfile::tempdir().unwrap();
        let manifest = folder.path().join("sequence.toml");
        let own = "name = \"walk\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\nheight = 1750";
        let seen = "camera = \"c1\"\nsource = \"c1.mp4\"\nbackground = \"plates/c1.png\"\nbackground_doubtful = 2.0";
        std::fs::write(&manifest, format!("{own}\n{whole}\n[[view]]\n{seen}\n{view}\n")).unwrap();
        let camera = Camera { name: "c1".to_string(), ..crate::track::fit_tests::cameras_around().remove(0) };
        Kept::read(&manifest, 1).unwrap().remark(&[camera], &[])
    }

    #[test]
    fn what_is_written_anyway_is_not_said_to_be_kept() {
        assert_eq!(remark("", ""), None);
        assert_eq!(remark("measure_again = true", ""), None);
    }

    #[test]
    fn what_a_user_wrote_is_named() {
        let said = remark(
            "measure_again = false\ntimestamps = \"ignore\"\n[features.shadow]\nchroma = 5",
            "ignore = \"desk.png\"",
        );
        let said = said.unwrap();
        assert!(said.contains("`measure_again`") && said.contains("`timestamps`"), "{said}");
        assert!(said.contains("[features]") && said.contains("`ignore` of camera \"c1\""), "{said}");
    }
}
