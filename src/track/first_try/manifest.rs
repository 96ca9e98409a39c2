//! The manifest of a first try, as text.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use toml::{Table, Value};

use crate::files::seen_from;

/// What was measured of a person.
pub(super) const BODY: &str = "body.toml";
pub(super) const START: &str = "start.csv";

/// A file of a person, seen from the manifest; those of one who is tracked alone lie beside it.
pub(super) fn person_file(name: Option<&str>, file: &str) -> String {
    name.map_or_else(|| file.to_string(), |name| format!("{name}/{file}"))
}

/// A view of the manifest.
pub(super) struct ManifestView<'a> {
    pub(super) camera: &'a str,
    pub(super) source: &'a Path,
    pub(super) plate: Option<PathBuf>,
    /// How much of it is doubtful, % of the picture.
    pub(super) doubtful: f64,
    /// Frames by which its pictures come too late, as was found.
    pub(super) delay: Option<isize>,
    /// Keys that its user wrote.
    pub(super) kept: Option<&'a Table>,
}

/// What a manifest is written from.
pub(super) struct ManifestText<'a> {
    pub(super) name: &'a str,
    pub(super) fps: f64,
    pub(super) cameras: &'a Path,
    pub(super) height: f64,
    pub(super) scale: f64,
    /// Their names, where several people are tracked together.
    pub(super) people: &'a [String],
    pub(super) views: Vec<ManifestView<'a>>,
    /// Keys and tables that its user wrote.
    pub(super) kept: &'a Table,
}

impl ManifestText<'_> {
    /// The text of a sequence.toml in `folder`, which is there.
    ///
    /// # Errors
    /// When a file is not there, or has a name that no TOML holds.
    pub(super) fn text(&self, folder: &Path) -> Result<String> {
        let mut text = String::from(
            "# Written by `pantin start`; docs/FORMATS.md has every key. Paths are seen from this folder.\n",
        );
        let cameras = quoted(&named_in(folder, self.cameras)?);
        // Writing into a String cannot fail.
        let _ = writeln!(text, "name = {}\nfps = {:?}\ncameras = {cameras}", quoted(self.name), self.fps);
        if self.people.is_empty() {
            let [body, start] = [BODY, START].map(|file| person_file(None, file));
            let _ = writeln!(text, "body = {body:?}\nstart = {start:?}\nheight = {:?}", self.height);
        }
        let _ = writeln!(text, "scale = {:?}", self.scale);
        if !self.kept.contains_key("measure_again") {
            text.push_str("measure_again = true # the body: one posture does not tell all of it\n");
        }
        // A table takes all keys that follow.
        let (tables, keys): (Vec<_>, Vec<_>) = self.kept.iter().partition(|(_, value)| has_tables(value));
        text.push_str(&written(&keys)?);
        for name in self.people {
            let [body, start] = [BODY, START].map(|file| person_file(Some(name), file));
            let _ = writeln!(text, "\n[[person]]\nname = {}\nbody = {body:?}\nstart = {start:?}", quoted(name));
        }
        for view in &self.views {
            let source = quoted(&named_in(folder, view.source)?);
            let _ = writeln!(text, "\n[[view]]\ncamera = {}\nsource = {source}", quoted(view.camera));
            if let Some(plate) = &view.plate {
                let _ = writeln!(text, "background = {}", quoted(&named_in(folder, plate)?));
                if view.doubtful > 0.0 {
                    let _ = writeln!(
                        text,
                        "background_doubtful = {:.1} # % of the picture, as it was learnt",
                        view.doubtful
                    );
                }
            }
            if let Some(delay) = view.delay {
                let _ =
                    writeln!(text, "delay = {delay} # frames that its pictures come too late, as the silhouettes say");
            }
            text.push_str(&written(&view.kept.into_iter().flatten().collect::<Vec<_>>())?);
        }
        if !tables.is_empty() {
            let _ = write!(text, "\n{}", written(&tables)?);
        }
        Ok(text)
    }
}

/// Whether a value stands under a heading of its own.
fn has_tables(value: &Value) -> bool {
    value.is_table() || value.as_array().is_some_and(|values| values.iter().any(Value::is_table))
}

fn written(keys: &[(&String, &Value)]) -> Result<String> {
    let table: Table = keys.iter().map(|(key, value)| ((*key).clone(), (*value).clone())).collect();
    Ok(toml::to_string(&table)?)
}

fn quoted(text: &str) -> String {
    Value::String(text.to_string()).to_string()
}

/// A file, which may be a pattern of numbered pictures, as seen from a folder.
fn named_in(folder: &Path, file: &Path) -> Result<String> {
    let absolute = |path: &Path| path.canonicalize().with_context(|| format!("cannot find {}", path.display()));
    let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (folder, parent) = (absolute(folder)?, absolute(parent)?);
    // Of pictures that are numbered no file has the name.
    let seen = seen_from(&folder, &parent.join(file.file_name().unwrap_or_default()), usize::MAX);
    seen.into_os_string()
        .into_string()
        .map_err(|name| anyhow::anyhow!("{} is no UTF-8, expected another name", name.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_from_the_folder_and_odd_names_survive() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["walk", "videos"] {
            std::fs::create_dir(at(name)).unwrap();
        }
        assert_eq!(named_in(&at("walk"), &at("videos/a.mp4")).unwrap(), "../videos/a.mp4");
        assert_eq!(named_in(&at("walk"), &at("walk/a_%04d.png")).unwrap(), "a_%04d.png");
        assert!(named_in(&at("walk"), &at("none/a.mp4")).unwrap_err().to_string().contains("cannot find"));
        let cameras = at("cameras.toml");
        let source = at("videos/the \"first\".mp4");
        let kept_view: Table = "delay = -8\nignore = \"desk.png\"".parse().unwrap();
        let kept: Table = "timestamps = \"ignore\"\n[features.shadow]\nchroma = 5".parse().unwrap();
        let views = vec![ManifestView {
            camera: "c \\1",
            source: &source,
            plate: Some(at("walk/c.png")),
            doubtful: 2.25,
            delay: None,
            kept: Some(&kept_view),
        }];
        let (name, fps, height, scale) = ("a \"b\"", 25.0, 1720.0, 0.25);
        let mut text = ManifestText { name, fps, cameras: &cameras, height, scale, people: &[], views, kept: &kept };
        let table: Table = text.text(&at("walk")).unwrap().parse().unwrap();
        assert_eq!(table["name"].as_str(), Some("a \"b\""));
        assert_eq!(table["view"][0]["camera"].as_str(), Some("c \\1"));
        assert_eq!(table["view"][0]["source"].as_str(), Some("../videos/the \"first\".mp4"));
        assert_eq!(table["view"][0]["background"].as_str(), Some("c.png"));
        assert_eq!(table["view"][0]["background_doubtful"].as_float(), Some(2.2));
        assert_eq!(table["cameras"].as_str(), Some("../cameras.toml"));
        assert_eq!((table["view"][0]["delay"].as_integer(), table["timestamps"].as_str()), (Some(-8), Some("ignore")));
        assert_eq!(table["features"]["shadow"]["chroma"].as_integer(), Some(5));
        assert_eq!(table["measure_again"].as_bool(), Some(true));
        assert_eq!((table["body"].as_str(), table["height"].as_float()), (Some("body.toml"), Some(1720.0)));
        let people = ["anna", "ben"].map(str::to_string);
        text.people = &people;
        let table: Table = text.text(&at("walk")).unwrap().parse().unwrap();
        assert_eq!(table["person"][1]["name"].as_str(), Some("ben"));
        assert_eq!(table["person"][1]["start"].as_str(), Some("ben/start.csv"));
        assert!(["body", "start", "height"].iter().all(|key| !table.contains_key(*key)));
        assert_eq!(table["measure_again"].as_bool(), Some(true));
        assert_eq!(table["view"][0]["camera"].as_str(), Some("c \\1"));
    }
}
