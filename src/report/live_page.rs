//! The page of a run at work: the report's overlays and player, fed by server-sent events, and the last half minute as curves.

use std::fmt::Write as _;

use anyhow::Result;
use serde::Serialize;

use super::Player;
use super::html::{PLAYER, PLAYER_SCRIPT, STYLE, embedded_json, escape};

const LIVE_STYLE: &str = include_str!("live.css");
const LIVE_SCRIPT: &str = include_str!("live.js");

/// What the page of a run at work begins with.
#[derive(Clone, Debug)]
pub struct LivePage {
    /// The heading.
    pub title: String,
    /// A line under it.
    pub subtitle: String,
    /// The views: name and size of the picture.
    pub views: Vec<(String, [u32; 2])>,
    /// The tracked skeleton, with its points' names and without frames, and the cameras.
    pub player: Player,
    /// How old a pose may be, ms.
    pub deadline_ms: Option<f64>,
}

/// What the script is given.
#[derive(Serialize)]
struct Setup<'a> {
    player: &'a Player,
    joints: &'a [String],
    deadline: Option<f64>,
}

const HEADLINES: [(&str, &str); 5] = [
    ("rate", "poses a second"),
    ("latency", "age of a pose, half within"),
    ("slowest", "age of a pose, 99 % within"),
    ("confidence", "confidence"),
    ("expected", "expected error of a joint"),
];

const LINES: [(&str, &str); 3] = [
    ("confidence", "Confidence, red where the person is lost"),
    ("expected", "Expected error, mean over the joints"),
    ("latency", "Age of a pose when it is out"),
];

/// The page as text. It asks its server for `events` and `view/N`, and nobody for anything else.
///
/// # Errors
/// When the player's data cannot be written.
pub fn live_page(data: &LivePage) -> Result<String> {
    let mut body = String::new();
    let out = &mut body;
    let (title, subtitle) = (escape(&data.title), escape(&data.subtitle));
    write!(
        out,
        "<header><h1>{title} <span class=\"state\">connecting</span></h1><p class=\"subtitle\">{subtitle}</p></header>\
         <div class=\"headlines\">"
    )?;
    for (name, label) in HEADLINES {
        write!(out, "<div><b data-value=\"{name}\">–</b><span>{label}</span></div>")?;
    }
    out.push_str(
        "</div><div class=\"pair\"><section id=\"overlays\"><h2>The model over the pictures</h2><div class=\"views\">",
    );
    for (name, [width, height]) in &data.views {
        let name = escape(name);
        write!(
            out,
            "<figure style=\"--ratio:{width}/{height}\"><img alt=\"{name}\"><figcaption>{name}</figcaption></figure>"
        )?;
    }
    write!(out, "</div><p class=\"hint\" data-value=\"shown\">no picture yet</p></section>{PLAYER}</div>")?;
    out.push_str("<section><h2>The last half minute</h2><div class=\"lines\">");
    for (name, label) in LINES {
        let dashed = if name == "latency" && data.deadline_ms.is_some() { ", dashed the deadline" } else { "" };
        write!(
            out,
            "<div><h3>{label}{dashed} <b data-value=\"line-{name}\"></b></h3><canvas data-line=\"{name}\"></canvas></div>"
        )?;
    }
    out.push_str("</div></section>");
    let joints = data.player.skeletons.first().map(|skeleton| skeleton.names.as_slice()).unwrap_or_default();
    let setup = embedded_json(&Setup { player: &data.player, joints, deadline: data.deadline_ms })?;
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{title}</title>\
         <style>{STYLE}{LIVE_STYLE}</style></head>\n<body class=\"live\"><main>{body}\n<footer>pantin {}</footer></main>\
         <script type=\"application/json\" id=\"player-data\">{setup}</script>\
         <script>{PLAYER_SCRIPT}{LIVE_SCRIPT}</script></body></html>\n",
        env!("CARGO_PKG_VERSION"),
    ))
}

#[cfg(test)]
mod tests {
    use super::super::Skeleton;
    use super::*;

    #[test]
    fn hostile_names_stay_text_and_nothing_is_fetched_from_elsewhere() {
        let evil = "</script><script>alert('x')</script>\"&".to_string();
        let skeleton =
            Skeleton { name: evil.clone(), names: vec![evil.clone()], bones: vec![[0, 0]], frames: Vec::new() };
        let text = live_page(&LivePage {
            title: evil.clone(),
            subtitle: evil.clone(),
            views: vec![(evil.clone(), [480, 270])],
            player: Player { fps: 25.0, skeletons: vec![skeleton], cameras: Vec::new() },
            deadline_ms: Some(80.0),
        })
        .unwrap();
        assert!(!text.contains("<script>alert") && text.matches("<script").count() == 2, "{text}");
        assert_eq!(text.matches("</script>").count(), 2, "only the two of the page");
        assert!(text.contains("--ratio:480/270") && text.contains("\"deadline\":80.0"), "{text}");
        for word in ["http://", "https://", "@import", "url(", "<link"] {
            assert!(!text.contains(word), "{word}");
        }
    }
}
