//! The report: one HTML file with everything in it, opened from the disk without a network.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use anyhow::{Context, Result};
use base64::Engine as _;
use glam::DVec3;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use serde::Serialize;

use super::plot::{Series, bar_chart, line_chart};
use crate::files::{Overwrite, write_atomically};

/// Everything a report shows. Empty lists and `None` leave their section out.
#[derive(Clone, Debug, Default)]
pub struct ReportData {
    /// The heading.
    pub title: String,
    /// A line under it.
    pub subtitle: String,
    /// The few numbers that matter most.
    pub headlines: Vec<Headline>,
    /// Sentences a reader must not miss.
    pub warnings: Vec<String>,
    /// Sentences on what was made of the input, by which nothing is amiss.
    pub notes: Vec<String>,
    /// Index of the first frame of the curves and of the player.
    pub first_frame: usize,
    /// Curves of the error, mm.
    pub errors_per_frame: Vec<Series>,
    /// Curves of the fitness, 0 to 1.
    pub fitness_per_frame: Vec<Series>,
    /// The error of each joint.
    pub joint_errors: Vec<JointError>,
    /// Overlays of chosen frames.
    pub overlays: Vec<OverlayFrame>,
    /// What the 3D player plays.
    pub player: Option<Player>,
    /// Time a stage takes.
    pub stages: Vec<StageTime>,
    /// Every setting: name and value.
    pub settings: Vec<(String, String)>,
}

/// A number to read at a glance.
#[derive(Clone, Debug)]
pub struct Headline {
    /// `48 mm`
    pub value: String,
    /// `mean joint error`
    pub label: String,
}

/// Error of one joint, mm.
#[derive(Clone, Debug)]
pub struct JointError {
    /// Its name.
    pub name: String,
    /// Mean over frames.
    pub mean: f64,
    /// Standard deviation over frames.
    pub deviation: f64,
    /// The largest.
    pub largest: f64,
}

/// Mean time of a stage, ms a frame.
#[derive(Clone, Debug)]
pub struct StageTime {
    /// Its name.
    pub name: String,
    /// Milliseconds a frame.
    pub ms: f64,
}

/// A frame's overlays.
#[derive(Clone, Debug)]
pub struct OverlayFrame {
    /// The frame.
    pub frame: usize,
    /// Name of the view and its picture.
    pub views: Vec<(String, RgbImage)>,
}

/// Moving points and the lines between them.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Skeleton {
    /// Its name.
    pub name: String,
    /// Names of the points, for those who show them.
    #[serde(skip)]
    pub names: Vec<String>,
    /// Pairs of indices of points.
    pub bones: Vec<[usize; 2]>,
    /// One row a frame, one entry a point; world, z up, mm.
    #[serde(serialize_with = "points_as_json")]
    pub frames: Vec<Vec<Option<DVec3>>>,
}

/// A camera as the player draws it.
#[derive(Clone, Debug, Serialize)]
pub struct CameraFrame {
    /// Its name.
    pub name: String,
    /// Its centre in the world, mm.
    #[serde(serialize_with = "point_as_json")]
    pub centre: DVec3,
    /// The corners of its picture as directions in the world, in order round the picture.
    #[serde(serialize_with = "corners_as_json")]
    pub corners: [DVec3; 4],
}

/// What the 3D player shows.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Player {
    /// Frames a second.
    pub fps: f64,
    /// The tracked skeleton, then the reference where there is one; rows of both start at the same frame.
    pub skeletons: Vec<Skeleton>,
    /// The cameras.
    pub cameras: Vec<CameraFrame>,
}

pub(super) const STYLE: &str = include_str!("page.css");
pub(super) const PLAYER_SCRIPT: &str = include_str!("player.js");
const SCRIPT: &str = include_str!("page.js");
const TRACKED: [u8; 3] = [31, 111, 178];

/// Writes [`page`] to `path`.
///
/// # Errors
/// When the page cannot be made or the file not written.
pub fn write_page(path: &Path, data: &ReportData, overwrite: Overwrite) -> Result<()> {
    let text = page(data)?;
    write_atomically(path, overwrite, |writer| Ok(writer.write_all(text.as_bytes())?))
}

/// The page as text.
///
/// # Errors
/// When a picture cannot be encoded.
pub fn page(data: &ReportData) -> Result<String> {
    let mut body = String::new();
    let out = &mut body;
    write!(
        out,
        "<header><h1>{}</h1><p class=\"subtitle\">{}</p></header>",
        escape(&data.title),
        escape(&data.subtitle)
    )?;
    if !data.headlines.is_empty() {
        out.push_str("<div class=\"headlines\">");
        for headline in &data.headlines {
            let (value, label) = (escape(&headline.value), escape(&headline.label));
            write!(out, "<div><b>{value}</b><span>{label}</span></div>")?;
        }
        out.push_str("</div>");
    }
    for (class, heading, sentences) in [("warnings", "Warnings", &data.warnings), ("notes", "Notes", &data.notes)] {
        if !sentences.is_empty() {
            write!(out, "<section class=\"{class}\"><h2>{heading}</h2><ul>")?;
            for sentence in sentences {
                write!(out, "<li>{}</li>", escape(sentence))?;
            }
            out.push_str("</ul></section>");
        }
    }
    overlays(out, &data.overlays)?;
    if data.player.as_ref().is_some_and(|player| player.skeletons.iter().any(|s| !s.frames.is_empty())) {
        out.push_str(PLAYER);
    }
    plots(out, data)?;
    tables(out, data)?;
    let player = embedded_json(&(data.first_frame, &data.player))?;
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{}</title>\
         <style>{STYLE}</style></head>\n<body><main>{body}\n<footer>pantin {}</footer></main>\
         <script type=\"application/json\" id=\"player-data\">{}</script><script>{PLAYER_SCRIPT}{SCRIPT}</script></body></html>\n",
        escape(&data.title),
        env!("CARGO_PKG_VERSION"),
        player,
    ))
}

/// Data for a script element, which only `<` could end.
pub(super) fn embedded_json(data: &impl Serialize) -> Result<String> {
    Ok(serde_json::to_string(data).context("cannot write the player's data")?.replace('<', "\\u003c"))
}

pub(super) const PLAYER: &str = "<section id=\"player\"><h2>Motion in space</h2><div class=\"stage\"><canvas></canvas>\
    <div class=\"legend\"></div></div>\
    <div class=\"controls\"><button type=\"button\" class=\"play\" aria-label=\"play or pause\">&#10074;&#10074;</button>\
    <input type=\"range\" min=\"0\" value=\"0\" aria-label=\"frame\"><output></output>\
    <label><input type=\"checkbox\" class=\"beside\"> reference beside</label>\
    <label><input type=\"checkbox\" class=\"trails\" checked> trails</label>\
    <label><input type=\"checkbox\" class=\"cameras\" checked> cameras</label></div>\
    <p class=\"hint\">Drag to turn, scroll or pinch to zoom, double-click to reset.</p></section>";

fn overlays(out: &mut String, frames: &[OverlayFrame]) -> Result<()> {
    if frames.is_empty() {
        return Ok(());
    }
    let picked = frames.len() / 2;
    // Above the pictures: where these are tall, what moves them is still in sight.
    write!(
        out,
        "<section id=\"overlays\"><h2>The model over the pictures</h2>\
         <div class=\"controls\"><input type=\"range\" min=\"0\" max=\"{}\" value=\"{picked}\" aria-label=\"frame\">\
         <output>frame {}</output></div>",
        frames.len() - 1,
        frames[picked].frame
    )?;
    for (index, frame) in frames.iter().enumerate() {
        let hidden = if index == picked { "" } else { " hidden" };
        let is_upright = |(_, picture): &(String, RgbImage)| picture.height() > picture.width();
        let upright = if frame.views.iter().all(is_upright) { " upright" } else { "" };
        write!(out, "<div class=\"views{upright}\" data-frame=\"{}\"{hidden}>", frame.frame)?;
        for (name, picture) in &frame.views {
            let name = escape(name);
            write!(
                out,
                "<figure><img alt=\"{name}, frame {}\" width=\"{}\" height=\"{}\" src=\"data:image/jpeg;base64,{}\">\
                 <figcaption>{name}</figcaption></figure>",
                frame.frame,
                picture.width(),
                picture.height(),
                embedded(picture)?
            )?;
        }
        out.push_str("</div>");
    }
    out.push_str("</section>");
    Ok(())
}

/// A plot drawn twice: for a window of a desk, and for a phone's, on which the other's letters would be too small to be read. The style
/// shows one of them.
fn plot(out: &mut String, drawn: impl Fn(bool) -> Result<String>) -> Result<()> {
    write!(out, "<div class=\"plot wide\">{}</div><div class=\"plot narrow\">{}</div>", drawn(false)?, drawn(true)?)?;
    Ok(())
}

fn plots(out: &mut String, data: &ReportData) -> Result<()> {
    for (heading, axis, series) in [
        ("Error over time", "error, mm", &data.errors_per_frame),
        ("Fitness over time", "fitness", &data.fitness_per_frame),
    ] {
        if !series.is_empty() {
            write!(out, "<section><h2>{heading}</h2>")?;
            plot(out, |is_narrow| {
                let size = if is_narrow { [340, 260] } else { [1080, 240] };
                line_chart(axis, data.first_frame, series, size)
            })?;
            out.push_str("</section>");
        }
    }
    Ok(())
}

fn tables(out: &mut String, data: &ReportData) -> Result<()> {
    out.push_str("<div class=\"columns\">");
    if !data.joint_errors.is_empty() {
        out.push_str(
            "<section><h2>Error a joint</h2><table><thead><tr><th>joint</th><th>mean, mm</th><th>deviation</th>\
             <th>largest</th></tr></thead><tbody>",
        );
        for joint in &data.joint_errors {
            write!(
                out,
                "<tr><td>{}</td><td>{:.1}</td><td>{:.1}</td><td>{:.1}</td></tr>",
                escape(&joint.name),
                joint.mean,
                joint.deviation,
                joint.largest
            )?;
        }
        out.push_str("</tbody></table></section>");
    }
    out.push_str("<div>");
    if !data.stages.is_empty() {
        let bars: Vec<(String, f64)> = data.stages.iter().map(|stage| (stage.name.clone(), stage.ms)).collect();
        out.push_str("<section><h2>Time a frame</h2>");
        plot(out, |is_narrow| bar_chart(&bars, "ms", TRACKED, if is_narrow { 340 } else { 500 }))?;
        out.push_str("</section>");
    }
    if !data.settings.is_empty() {
        out.push_str("<section><h2>Settings</h2><table class=\"settings\"><tbody>");
        for (name, value) in &data.settings {
            write!(out, "<tr><th>{}</th><td>{}</td></tr>", escape(name), escape(value))?;
        }
        out.push_str("</tbody></table></section>");
    }
    out.push_str("</div></div>");
    Ok(())
}

/// A picture as JPEG, for a page.
///
/// # Errors
/// When it cannot be encoded: it is larger than a JPEG can be.
pub fn jpeg(picture: &RgbImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    JpegEncoder::new_with_quality(&mut bytes, 86).encode_image(picture).context("cannot encode an overlay")?;
    Ok(bytes.into_inner())
}

fn embedded(picture: &RgbImage) -> Result<String> {
    Ok(base64::engine::general_purpose::STANDARD.encode(jpeg(picture)?))
}

/// Text for an element or a quoted attribute.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' && c != '\t' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Whole millimetres: the player shows no more, and the page stays small. What is missing or not finite is null.
fn rounded(point: Option<DVec3>) -> Option<[f64; 3]> {
    point.filter(|p| p.is_finite()).map(|p| p.round().to_array())
}

fn points_as_json<S: serde::Serializer>(frames: &[Vec<Option<DVec3>>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(frames.iter().map(|row| row.iter().map(|p| rounded(*p)).collect::<Vec<_>>()))
}

fn point_as_json<S: serde::Serializer>(point: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
    rounded(Some(*point)).serialize(serializer)
}

fn corners_as_json<S: serde::Serializer>(corners: &[DVec3; 4], serializer: S) -> Result<S::Ok, S::Error> {
    corners.map(|corner| corner.to_array()).serialize(serializer)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everything() -> ReportData {
        let evil = "</script><script>alert('x')</script>\"&".to_string();
        let curve = |scale: f64| Series {
            name: evil.clone(),
            colour: TRACKED,
            values: (0..40).map(|i| Some(scale * (2.0 + f64::from(i).sin()))).collect(),
            is_band: false,
        };
        let walker = |shift: f64| Skeleton {
            name: evil.clone(),
            names: Vec::new(),
            bones: vec![[0, 1], [1, 2]],
            frames: (0..40)
                .map(|i| vec![Some(DVec3::new(f64::from(i) * 20.0 + shift, 0.0, 900.0)), None, Some(DVec3::NAN)])
                .collect(),
        };
        ReportData {
            title: evil.clone(),
            subtitle: evil.clone(),
            headlines: vec![Headline { value: evil.clone(), label: evil.clone() }],
            warnings: vec![evil.clone()],
            notes: vec![evil.clone()],
            first_frame: 3,
            errors_per_frame: vec![curve(20.0), curve(10.0)],
            fitness_per_frame: vec![curve(0.2)],
            joint_errors: vec![JointError { name: evil.clone(), mean: 1.0, deviation: f64::NAN, largest: 3.0 }],
            overlays: vec![OverlayFrame { frame: 3, views: vec![(evil.clone(), RgbImage::new(8, 6))] }],
            player: Some(Player { fps: 25.0, skeletons: vec![walker(0.0), walker(30.0)], cameras: Vec::new() }),
            stages: vec![StageTime { name: evil.clone(), ms: 3.25 }],
            settings: vec![(evil.clone(), evil.clone())],
        }
    }

    #[test]
    fn hostile_names_stay_text() {
        let text = page(&everything()).unwrap();
        assert!(!text.contains("<script>alert"), "a name became a script");
        assert_eq!(text.matches("</script>").count(), 2, "only the two of the page");
        assert_eq!(text.matches("<script").count(), 2);
        assert!(text.contains("&lt;/script&gt;"));
    }

    #[test]
    fn nothing_is_fetched_from_elsewhere() {
        let text = page(&everything()).unwrap();
        // The namespace of SVG is a name, not an address that is visited.
        let text = text.replace("http://www.w3.org/2000/svg", "");
        for word in ["http://", "https://", "@import", "url(", "<link"] {
            assert!(!text.contains(word), "{word}");
        }
        assert!(text.contains("data:image/jpeg;base64,/9j/"));
    }

    #[test]
    fn missing_points_are_null_and_an_empty_report_is_a_page() {
        let text = page(&everything()).unwrap();
        assert!(text.contains("[[0.0,0.0,900.0],null,null]"), "{text}");
        assert!(text.contains("<h2>Warnings</h2>") && text.contains("<section class=\"notes\"><h2>Notes</h2>"));
        let empty = page(&ReportData::default()).unwrap();
        assert!(empty.starts_with("<!DOCTYPE html>") && empty.ends_with("</html>\n"));
        assert!(!empty.contains("<canvas") && !empty.contains("<table"));
    }

    #[test]
    fn a_phone_has_plots_of_its_own_and_upright_pictures_stand_side_by_side_under_their_slider() {
        let mut data = everything();
        let text = page(&data).unwrap();
        assert_eq!(
            [text.matches("class=\"plot wide\"").count(), text.matches("class=\"plot narrow\"").count()],
            [3; 2]
        );
        assert!(
            text.contains("<svg width=\"340\" height=\"260\"") && text.contains("<svg width=\"1080\" height=\"240\"")
        );
        assert!(text.contains("<div class=\"views\" data-frame"), "pictures that lie");
        data.overlays[0].views[0].1 = RgbImage::new(6, 8);
        let text = page(&data).unwrap();
        assert!(text.contains("<div class=\"views upright\" data-frame"));
        let overlays = &text[text.find("id=\"overlays\"").unwrap()..];
        assert!(overlays.find("type=\"range\"") < overlays.find("<figure>"), "the slider is above");
    }

    #[test]
    fn the_file_is_written_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.html");
        write_page(&path, &everything(), Overwrite::Refuse).unwrap();
        let error = write_page(&path, &everything(), Overwrite::Refuse).unwrap_err();
        assert!(format!("{error:#}").contains("report.html exists already"), "{error:#}");
    }
}
