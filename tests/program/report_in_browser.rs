//! report.html in a real browser, without a screen and without a network: nothing fails in it, the slider shows another
//! frame's overlays, the player draws.

use std::path::Path;
use std::process::Command;

use serde_json::json;

use super::support::{program, succeeded};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

fn browser() -> Option<&'static str> {
    let runs = |name: &&&str| Command::new(name).arg("--version").output().is_ok_and(|it| it.status.success());
    BROWSERS.iter().find(runs).copied()
}

/// Stands before the page's own scripts: keeps what fails in them, and draws by the clock, which runs ahead here, since a
/// browser without a screen asks for pictures when it likes.
const LISTEN: &str = "<script>window.failures=[];\
    window.requestAnimationFrame=draw=>setTimeout(()=>draw(performance.now()),16);\
    addEventListener('error',e=>failures.push(String(e.message||e.target.src)),true);</script>";

/// Stands behind them: uses the page as a reader would, and leaves what came of it in the document.
const USE: &str = r#"<script>
const told = {};
const section = document.getElementById("overlays"), slider = section.querySelector("input");
const shown = () => [...section.querySelectorAll(".views")].findIndex(v => !v.hidden);
told.frames = +slider.max + 1;
told.atFirst = shown() === +slider.value;
told.shown = [slider.max, slider.min].map(frame => {
  slider.value = frame;
  slider.dispatchEvent(new Event("input"));
  return shown();
});
told.pictures = [...section.querySelectorAll(".views:not([hidden]) img")].every(i => i.complete && i.naturalWidth > 100);
const player = document.getElementById("player"), canvas = player.querySelector("canvas");
const inks = () => {
  const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  const seen = new Set();
  for (let i = 0; i < bytes.length; i += 4) if (bytes[i + 3] > 0) seen.add(bytes.slice(i, i + 3).join());
  return seen.size;
};
setTimeout(() => {
  told.colours = inks();
  told.plots = document.querySelectorAll("svg polyline, svg path").length;
  told.far = [...document.querySelectorAll("[src],[href]")]
    .map(e => e.getAttribute("src") || e.getAttribute("href")).filter(a => /^(https?:)?\/\//.test(a)).length;
  told.failures = failures;
  const out = document.createElement("pre");
  out.id = "told";
  out.textContent = JSON.stringify(told);
  document.body.append(out);
}, 400);
</script>"#;

fn seen_in(browser: &str, page: &Path, profile: &Path) -> serde_json::Value {
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--host-resolver-rules=MAP * ~NOTFOUND",
        ])
        .args(["--window-size=1200,900", "--virtual-time-budget=4000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let (_, rest) = dom
        .split_once("<pre id=\"told\">")
        .unwrap_or_else(|| panic!("the page's scripts did not end: {}", String::from_utf8_lossy(&output.stderr)));
    serde_json::from_str(rest.split_once("</pre>").unwrap().0).unwrap()
}

#[test]
fn the_report_works_in_a_browser() {
    let Some(browser) = browser() else {
        println!("SKIPPED the_report_works_in_a_browser: none of {} is installed", BROWSERS.join(", "));
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let demo = folder.path().join("demo");
    let made = program()
        .args(["demo", "--frames", "11", "--particles", "40", "--iterations", "3", "-o"])
        .arg(&demo)
        .output()
        .unwrap();
    succeeded(&made);
    let report = std::fs::read_to_string(demo.join("report.html")).unwrap();
    let page = |text: &str, name: &str| {
        let text =
            text.replacen("<head>", &format!("<head>{LISTEN}"), 1).replacen("</body>", &format!("{USE}</body>"), 1);
        assert!(text.contains("window.failures") && text.contains("told.shown"), "the page has a head and a body");
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        seen_in(browser, &path, &folder.path().join("profile"))
    };

    let told = page(&report, "report.html");
    assert_eq!(told["failures"], json!([]), "{told}");
    let frames = told["frames"].as_i64().unwrap();
    assert!(frames > 1, "{told}");
    assert_eq!((&told["atFirst"], &told["shown"]), (&json!(true), &json!([frames - 1, 0])), "{told}");
    assert_eq!(told["pictures"], true, "{told}");
    assert!(told["colours"].as_i64().unwrap() > 20 && told["plots"].as_i64().unwrap() > 3, "{told}");
    assert_eq!(told["far"], 0, "{told}");

    // A page whose script is broken does not pass for a good one.
    let broken = page(&report.replacen("function drawFloor()", "function drawFloors()", 1), "broken.html");
    assert_ne!(broken["failures"], json!([]), "{broken}");
}
