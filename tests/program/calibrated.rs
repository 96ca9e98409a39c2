//! The constants of expected errors (docs/METHOD.md A13), fitted on scenes drawn by lot and tried on those held out.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use pantin::motion::read_points;
use pantin::track::WRONG;
use plotters::prelude::*;

use super::support::{self, succeeded};

/// Kinds of joints, left and right together.
const KINDS: [&str; 12] =
    ["pelvis", "hip", "knee", "ankle", "axis", "thorax", "clavicle", "shoulder", "elbow", "wrist", "head", "head_top"];
/// What else the logarithm of the error is a sum of.
const TERMS: [&str; 6] = ["LOOSENESS", "SUPPORT", "FITNESS", "SEEN", "SPREAD", "ONCE"];
/// Kinds and terms, in the logarithm of what a frame leaves open; then the logarithms of what bodies are off by, a kind each, mm; and last the
/// factor of the ambiguity.
const COUNT: usize = BODY + KINDS.len() + 1;
const BODY: usize = KINDS.len() + TERMS.len();
const AMBIGUITY: usize = COUNT - 1;
/// Parts that the scenes are dealt into: each is judged by constants fitted on the others.
const PARTS: usize = 8;
/// Share of the joints that are to be within their expected error.
const SHARE: f64 = 0.6827;
/// A frame off by more than this on average is far off, and its joints should expect more than that, mm.
const FAR: f64 = 100.0;
const SAID: f64 = 70.0;
/// How scenes are tracked, by which manifest and with what options: as by default, worse, so that there are wrong poses, and by masks that are
/// right, which are fitted best.
const RUNS: [(&str, &[&str]); 5] = [
    ("sequence.toml", &[]),
    ("sequence.toml", &["--particles", "100", "--iterations", "8", "--seed", "2", "--objective", "sp"]),
    ("sequence.toml", &["--particles", "64", "--iterations", "8", "--seed", "3"]),
    ("sequence.toml", &["--passes", "forward"]),
    ("exact.toml", &[]),
];

/// A joint in a frame.
struct Joint {
    scene: usize,
    /// Which of [`RUNS`].
    run: usize,
    frame: usize,
    /// Index in [`KINDS`].
    kind: usize,
    terms: [f64; TERMS.len()],
    /// mm.
    ambiguity: f64,
    /// Logarithm of its distance from the truth, mm.
    error: f64,
}

impl Joint {
    /// The squares that its expected error is the root of the sum of, mm: what the frame leaves open, the body, the ambiguity. `means` is
    /// what [`TERMS`] are taken from.
    fn squares(&self, weights: &[f64; COUNT], means: &[f64; TERMS.len()]) -> [f64; 3] {
        let terms = self.terms.iter().zip(means).zip(&weights[KINDS.len()..]);
        let open: f64 = weights[self.kind] + terms.map(|((term, mean), weight)| (term - mean) * weight).sum::<f64>();
        [(2.0 * open).exp(), (2.0 * weights[BODY + self.kind]).exp(), (weights[AMBIGUITY] * self.ambiguity).powi(2)]
    }
}

/// The constants of a joint's kind and terms, of its kind's body and of the ambiguity; and of the logit of a wrong pose.
struct Fitted {
    weights: [f64; COUNT],
    wrong: [f64; 2],
}

/// Gradient descent with the steps of Adam, ever smaller.
fn descend<const N: usize>(
    mut at: [f64; N],
    rate: f64,
    steps: i32,
    gradient: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let (mut mean, mut square) = ([0.0; N], [0.0; N]);
    for step in 1..=steps {
        let slope = gradient(&at);
        let rate = rate * (1.0 - f64::from(step) / f64::from(steps));
        for i in 0..N {
            mean[i] += 0.1 * (slope[i] - mean[i]);
            square[i] += 0.01 * (slope[i] * slope[i] - square[i]);
            let [mean, square] = [mean[i] / (1.0 - 0.9_f64.powi(step)), square[i] / (1.0 - 0.99_f64.powi(step))];
            at[i] -= rate * mean / (square.sqrt() + 1e-8);
        }
    }
    at
}

/// The logarithm of a joint's expected error, mm.
fn expected(joint: &Joint, weights: &[f64; COUNT]) -> f64 {
    0.5 * joint.squares(weights, &[0.0; TERMS.len()]).iter().sum::<f64>().ln()
}

/// Expected errors against errors of the joints of a frame, mm.
struct Frame {
    run: usize,
    /// Root mean squares.
    square: [f64; 2],
    /// Means.
    mean: [f64; 2],
}

/// The frames that joints are of, in their order.
fn frames(joints: &[&Joint], weights: &[f64; COUNT]) -> Vec<Frame> {
    let mut sums: BTreeMap<usize, (Frame, f64)> = BTreeMap::new();
    for joint in joints {
        let nothing = Frame { run: joint.run, square: [0.0; 2], mean: [0.0; 2] };
        let (sum, count) = sums.entry(joint.frame).or_insert((nothing, 0.0));
        for (i, logarithm) in [expected(joint, weights), joint.error].into_iter().enumerate() {
            sum.square[i] += (2.0 * logarithm).exp();
            sum.mean[i] += logarithm.exp();
        }
        *count += 1.0;
    }
    let over = |(Frame { run, square, mean }, count): (Frame, f64)| Frame {
        run,
        square: square.map(|sum| (sum / count).sqrt()),
        mean: mean.map(|sum| sum / count),
    };
    sums.into_values().map(over).collect()
}

/// The share of pairs of a bad frame and a good one of which more is said of the bad one.
fn area(said: &[(f64, bool)]) -> f64 {
    let of = |wanted: bool| said.iter().filter(move |(_, is_bad)| *is_bad == wanted).map(|(said, _)| *said);
    let pairs = of(true).flat_map(|bad| {
        of(false).map(move |good| if bad > good { 1.0 } else { 0.5 * f64::from(u8::from(bad >= good)) })
    });
    let (sum, count) = pairs.fold((0.0, 0.0), |(sum, count), pair| (sum + pair, count + 1.0));
    sum / f64::max(count, 1.0)
}

fn fit(joints: &[&Joint]) -> Fitted {
    let count = joints.len() as f64;
    let mut means = [0.0; TERMS.len()];
    for joint in joints {
        means.iter_mut().zip(joint.terms).for_each(|(mean, term)| *mean += term / count);
    }
    let mut errors: Vec<f64> = joints.iter().map(|joint| joint.error).collect();
    errors.sort_by(f64::total_cmp);
    let usual = errors[(SHARE * count) as usize];
    let mut start = [0.0; COUNT];
    start[..KINDS.len()].fill(usual);
    // Half of that for the body.
    start[BODY..AMBIGUITY].fill(usual - 2.0_f64.ln());
    start[AMBIGUITY] = 1.0;
    let mut weights = descend(start, 0.03, 1500, |weights| {
        let mut slope = [0.0; COUNT];
        for joint in joints {
            let squares = joint.squares(weights, &means);
            let sum: f64 = squares.iter().sum();
            let missing = joint.error - 0.5 * sum.ln();
            let share = (if missing > 0.0 { SHARE } else { SHARE - 1.0 }) / count;
            let [open, body, ambiguity] = squares.map(|square| share * square / sum);
            slope[joint.kind] -= open;
            (0..TERMS.len()).for_each(|i| slope[KINDS.len() + i] -= open * (joint.terms[i] - means[i]));
            slope[BODY + joint.kind] -= body;
            slope[AMBIGUITY] -= ambiguity / weights[AMBIGUITY].max(1e-3);
        }
        (KINDS.len()..BODY).for_each(|i| slope[i] += 1e-3 * weights[i]);
        slope
    });
    let offset: f64 = means.iter().zip(&weights[KINDS.len()..]).map(|(mean, weight)| mean * weight).sum();
    weights[..KINDS.len()].iter_mut().for_each(|constant| *constant -= offset);
    let frames = frames(joints, &weights);
    let judged: Vec<(f64, bool)> = frames.iter().map(|frame| (frame.square[0].ln(), is_wrong(frame))).collect();
    let count = judged.len() as f64;
    let middle = judged.iter().map(|(expected, _)| expected).sum::<f64>() / count;
    let [constant, slope] = descend([0.0; 2], 0.05, 6000, |[constant, slope]| {
        let mut gradient = [0.0; 2];
        for (expected, is_wrong) in &judged {
            let x = expected - middle;
            let off = 1.0 / (1.0 + (-(constant + slope * x)).exp()) - f64::from(u8::from(*is_wrong));
            gradient = [gradient[0] + off / count, gradient[1] + off * x / count];
        }
        gradient
    });
    Fitted { weights, wrong: [constant - middle * slope, slope] }
}

/// The joints of a track, frames numbered from `frame` on.
fn read(track: &Path, truth: &Path, [scene, run]: [usize; 2], frame: usize, joints: &mut Vec<Joint>) -> usize {
    let (ours, truth) = (read_points(&track.join("joints.csv")).unwrap(), read_points(truth).unwrap());
    let mut reader = csv::Reader::from_path(track.join("confidence.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for (at, row) in rows.iter().enumerate() {
        let value = |name: &str| -> Option<f64> { row[header.iter().position(|it| it == name).unwrap()].parse().ok() };
        for (column, name) in ours.names.iter().enumerate() {
            let same = truth.names.iter().position(|known| known == name);
            let (Some(found), Some(Some(real))) = (ours.frames[at][column], same.map(|same| truth.frames[at][same]))
            else {
                continue;
            };
            let kind = name.strip_prefix("left_").or_else(|| name.strip_prefix("right_")).unwrap_or(name);
            let kind = KINDS.iter().position(|known| *known == kind).unwrap();
            let of = |what: &str| value(&format!("{name}.{what}")).unwrap();
            // Only who goes over the frames twice knows it.
            let ambiguity = value(&format!("{name}.ambiguity"));
            let terms = [
                (of("looseness") + 5.0).ln(),
                (1.0 - of("support")) * ((of("looseness") + 5.0) / 30.0).max(1.0).ln(),
                1.0 - value("fitness").unwrap(),
                1.0 - of("seen"),
                (of("spread") + 1.0).ln(),
                f64::from(u8::from(ambiguity.is_none())),
            ];
            let error = found.distance(real).max(1.0).ln();
            let ambiguity = ambiguity.unwrap_or(0.0);
            joints.push(Joint { scene, run, frame: frame + at, kind, terms, ambiguity, error });
        }
    }
    frame + rows.len()
}

/// Fits the constants on the scenes of the folder that `PANTIN_SCENES` names, one folder of `pantin synth --lottery` a scene, each as its user
/// has it: with the body that was measured in it, since that is what every real track is made with. Prints them, and writes how they
/// hold on the scenes left out into `target/tmp/calibrated`, where tracks stay and are taken up again by the next run:
/// `PANTIN_SCENES=... cargo test --release --test program calibrated:: -- --ignored --nocapture`.
#[test]
#[ignore = "needs scenes, and minutes of them; run it in release"]
fn expected_errors_hold_on_scenes_left_out() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calibrated");
    fs::create_dir_all(&folder).unwrap();
    let scenes = std::env::var("PANTIN_SCENES").expect("PANTIN_SCENES names a folder of scenes");
    let mut scenes: Vec<_> = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|scene| scene.join("sequence.toml").is_file());
    scenes.sort();
    let (mut joints, mut frame) = (Vec::new(), 0);
    for (at, scene) in scenes.iter().enumerate() {
        let name = scene.file_name().unwrap().to_str().unwrap();
        for (number, (manifest, options)) in RUNS.iter().enumerate() {
            let output = folder.join(format!("{name}-{number}"));
            if !output.join("report.html").exists() {
                let [sequence, out] = [&scene.join(manifest), &output].map(|path| path.to_str().unwrap().to_string());
                let common = ["track", &sequence, "-o", &out, "--force", "--overlay-every", "0", "--recover", "no"];
                succeeded(&support::pantin(&[&common[..], options].concat()));
            }
            frame = read(&output, &scene.join("truth.trc"), [at, number], frame, &mut joints);
        }
        println!("{}: {frame} frames so far", scene.display());
    }
    // Each by what the scenes of the other parts say.
    let (mut held, mut judged) = (Vec::new(), Vec::new());
    for part in 0..PARTS.min(scenes.len()) {
        let [tried, others] = [true, false].map(|is_it| -> Vec<&Joint> {
            joints.iter().filter(|joint| (joint.scene % PARTS == part) == is_it).collect()
        });
        let fitted = fit(&others);
        held.extend(tried.iter().map(|joint| (expected(joint, &fitted.weights), joint.error, joint.run)));
        let [constant, slope] = fitted.wrong;
        let said = |frame: &Frame| 1.0 / (1.0 + (-(constant + slope * frame.square[0].ln())).exp());
        judged.extend(frames(&tried, &fitted.weights).into_iter().map(|frame| (said(&frame), frame)));
    }
    held.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = "expected_mm,within,error_mm\n".to_string();
    println!("\n| expected error, mm | within it | 68 % of the errors, mm |\n|---|---|---|");
    let mut points = Vec::new();
    for tenth in held.chunks(held.len().div_ceil(10)) {
        let within = share_within(tenth);
        let mut errors: Vec<f64> = tenth.iter().map(|(_, error, _)| error.exp()).collect();
        errors.sort_by(f64::total_cmp);
        let [said, found] = [tenth[tenth.len() / 2].0.exp(), errors[(SHARE * errors.len() as f64) as usize]];
        println!("| {said:.1} | {:.1} % | {found:.1} |", 100.0 * within);
        writeln!(text, "{said:.3},{within:.4},{found:.3}").unwrap();
        points.push((said, found));
    }
    let within = share_within(&held);
    println!("\nAll: {:.1} % within.", 100.0 * within);
    tell_of_joints(&held);
    println!("\n| said to be wrong | frames | said | were |\n|---|---|---|---|");
    for range in [0.0..0.02, 0.02..0.05, 0.05..0.1, 0.1..0.3, 0.3..0.5, 0.5..1.01] {
        let some: Vec<_> = judged.iter().filter(|(said, _)| range.contains(said)).collect();
        let share = |sum: f64| 100.0 * sum / some.len().max(1) as f64;
        let (said, were) =
            (some.iter().map(|(said, _)| said).sum(), some.iter().filter(|(_, frame)| is_wrong(frame)).count());
        println!("| {range:?} | {} | {:.1} % | {:.1} % |", some.len(), share(said), share(were as f64));
    }
    tell_of_frames(&judged);
    fs::write(folder.join("reliability.csv"), text).unwrap();
    draw(&folder.join("reliability.svg"), &points);
    let Fitted { weights, wrong } = fit(&joints.iter().collect::<Vec<_>>());
    println!("\nOn all scenes, for src/track/confidence/calibration.rs:");
    let [open, body] = [&weights[..KINDS.len()], &weights[BODY..AMBIGUITY]];
    let line = |kind: &str, open: f64, body: f64| println!("    (\"{kind}\", {open:.3}, {:.1}),", body.exp());
    KINDS.iter().zip(open.iter().zip(body)).for_each(|(kind, (open, body))| line(kind, *open, *body));
    let mean = |weights: &[f64]| weights.iter().sum::<f64>() / weights.len() as f64;
    line("another", mean(open), mean(body));
    TERMS.iter().zip(&weights[KINDS.len()..]).for_each(|(term, weight)| println!("{term} {weight:.3}"));
    println!("AMBIGUITY {:.3}", weights[AMBIGUITY]);
    println!("WRONG_AT [{:.3}, {:.3}]", wrong[0], wrong[1]);
    assert!((0.6..0.76).contains(&within), "{within} of the joints held out are within their expected error");
}

fn is_wrong(frame: &Frame) -> bool {
    frame.square[1] > WRONG
}

/// How expected errors hold for each of [`RUNS`], and what they say of joints that are far off; (expected, error, run), in logarithms.
fn tell_of_joints(held: &[(f64, f64, usize)]) {
    println!(
        "\n| run | within | joints off by over {FAR} mm | of these expected over {SAID} | of the others | area |\n|---|---|---|---|---|---|"
    );
    for run in 0..RUNS.len() {
        let own: Vec<(f64, f64, usize)> = held.iter().copied().filter(|joint| joint.2 == run).collect();
        let said: Vec<(f64, bool)> =
            own.iter().map(|(expected, error, _)| (expected.exp(), error.exp() > FAR)).collect();
        let [far, others] = [true, false].map(|is_far| -> Vec<f64> {
            said.iter().filter(|(_, it)| *it == is_far).map(|(expected, _)| *expected).collect()
        });
        let over = |some: &[f64]| {
            100.0 * some.iter().filter(|expected| **expected > SAID).count() as f64 / some.len().max(1) as f64
        };
        let [within, area] = [100.0 * share_within(&own), area(&said)];
        println!(
            "| {run} | {within:.1} % | {} | {:.0} % | {:.1} % | {area:.3} |",
            far.len(),
            over(&far),
            over(&others)
        );
    }
}

/// What thresholds of `wrong` find, and what mean expected errors say of frames that are far off.
fn tell_of_frames(judged: &[(f64, Frame)]) {
    let count =
        |is_one: &dyn Fn(f64, &Frame) -> bool| judged.iter().filter(|(said, frame)| is_one(*said, frame)).count();
    let percent = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
    let wrong = count(&|_, frame| is_wrong(frame));
    println!(
        "\n| threshold | misses (of {wrong}) | false alarms (of {}) | said by run, and right |\n|---|---|---|---|",
        judged.len() - wrong
    );
    for threshold in [0.5, 0.6, 0.7, 0.8] {
        let misses = count(&|said, frame| is_wrong(frame) && said < threshold);
        let alarms = count(&|said, frame| !is_wrong(frame) && said >= threshold);
        let by_run = |run: usize| {
            let said = count(&|said, frame| frame.run == run && said >= threshold);
            format!("{said}, {}", count(&|said, frame| frame.run == run && said >= threshold && is_wrong(frame)))
        };
        let by_run: Vec<String> = (0..RUNS.len()).map(by_run).collect();
        let [misses, alarms] = [percent(misses, wrong), percent(alarms, judged.len() - wrong)];
        println!("| {threshold} | {misses:.0} % | {alarms:.1} % | {} |", by_run.join("; "));
    }
    let pairs = |said: &dyn Fn(f64, &Frame) -> (f64, bool)| -> Vec<(f64, bool)> {
        judged.iter().map(|(wrong, frame)| said(*wrong, frame)).collect()
    };
    let far = |frame: &Frame| frame.mean[1] > FAR;
    let many = count(&|_, frame| far(frame));
    println!(
        "\nArea under the curve: {:.2} for `wrong`, {:.2} of mean expected errors for the {many} frames off by more than {FAR} mm on average; of \
         these {:.0} % have one over {SAID} mm, of the others {:.0} %.",
        area(&pairs(&|said, frame| (said, is_wrong(frame)))),
        area(&pairs(&|_, frame| (frame.mean[0], far(frame)))),
        percent(count(&|_, frame| far(frame) && frame.mean[0] > SAID), many),
        percent(count(&|_, frame| !far(frame) && frame.mean[0] > SAID), judged.len() - many),
    );
    for run in 0..RUNS.len() {
        let wrong = count(&|_, frame| frame.run == run && is_wrong(frame));
        println!("Run {run}: {} frames, {wrong} wrong.", count(&|_, frame| frame.run == run));
    }
}

/// The share of errors that are at most the expected ones; (expected, error, run), in logarithms.
fn share_within(held: &[(f64, f64, usize)]) -> f64 {
    held.iter().filter(|(expected, error, _)| error <= expected).count() as f64 / held.len() as f64
}

/// What is said against what is found, both from 0.
fn draw(path: &Path, points: &[(f64, f64)]) {
    let end = points.iter().map(|(said, found)| said.max(*found)).fold(0.0, f64::max) * 1.05;
    let root = SVGBackend::new(path, (480, 440)).into_drawing_area();
    root.fill(&WHITE).unwrap();
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(54)
        .build_cartesian_2d(0.0..end, 0.0..end)
        .unwrap();
    chart.configure_mesh().x_desc("expected error, mm").y_desc("68 % of the errors are within, mm").draw().unwrap();
    chart.draw_series(LineSeries::new([(0.0, 0.0), (end, end)], BLACK.mix(0.4))).unwrap();
    chart.draw_series(points.iter().map(|point| Circle::new(*point, 4, BLUE.filled()))).unwrap();
    chart.draw_series(LineSeries::new(points.iter().copied(), BLUE)).unwrap();
    root.present().unwrap();
}
