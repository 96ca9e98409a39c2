//! Two profiles beside each other.

use std::fmt::{self, Display, Formatter};

use super::report::{Pass, Profile, ProfileReport};
use crate::gpu::Work;

/// Two profiles: what was measured before, and now.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The one that is compared with.
    pub before: &'a ProfileReport,
    /// The other.
    pub now: &'a ProfileReport,
}

impl Display for Comparison<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { before, now } = self;
        writeln!(f, "before: {} ({})", before.device, before.machine)?;
        writeln!(f, "now:    {} ({})", now.device, now.machine)?;
        for profile in &now.profiles {
            match before.profiles.iter().find(|other| is_same(other, profile)) {
                Some(other) => of_profile(f, other, profile)?,
                None => writeln!(f, "\n{}: only now", profile.title())?,
            }
        }
        for profile in &before.profiles {
            if !now.profiles.iter().any(|other| is_same(other, profile)) {
                writeln!(f, "\n{}: only before", profile.title())?;
            }
        }
        Ok(())
    }
}

fn is_same(left: &Profile, right: &Profile) -> bool {
    let of = |p: &Profile| (p.particles, p.views, p.width, p.height);
    (&left.backend, &left.variant, &left.model) == (&right.backend, &right.variant, &right.model)
        && of(left) == of(right)
}

fn of_profile(f: &mut Formatter<'_>, before: &Profile, now: &Profile) -> fmt::Result {
    writeln!(f, "\n{}", now.title())?;
    writeln!(
        f,
        "{:26} {:>9} {:>9} {:>7} {:>9} {:>9} {:>9}",
        "pass", "before", "now", "ratio", "int", "float", "memory"
    )?;
    times(f, "an iteration", before.ms, now.ms)?;
    writeln!(f)?;
    for pass in &now.passes {
        let Some(other) = before.passes.iter().find(|other| other.name == pass.name) else {
            writeln!(f, "{:26} {:>9} {:9.3}", pass.name, "-", pass.ms)?;
            continue;
        };
        times(f, &pass.name, other.ms, pass.ms)?;
        for of in [|work: &Work| work.integer, |work: &Work| work.float, Work::memory] {
            let done = |pass: &Pass| pass.work.as_ref().map(of).filter(|done| *done > 0);
            match (done(other), done(pass)) {
                (Some(before), Some(now)) => write!(f, " {:9.3}", now as f64 / before as f64)?,
                _ => write!(f, " {:>9}", "-")?,
            }
        }
        writeln!(f)?;
    }
    for pass in &before.passes {
        if !now.passes.iter().any(|other| other.name == pass.name) {
            writeln!(f, "{:26} {:9.3} {:>9}", pass.name, pass.ms, "-")?;
        }
    }
    Ok(())
}

/// Milliseconds before and now, and how many times as long it takes.
fn times(f: &mut Formatter<'_>, name: &str, before: f64, now: f64) -> fmt::Result {
    write!(f, "{name:26} {before:9.3} {now:9.3} {:7.3}", now / before)
}

#[cfg(test)]
mod tests {
    use super::super::peaks::Peaks;
    use super::*;

    fn report(backend: &str, passes: &[(&str, f64, u64)]) -> ProfileReport {
        let pass = |&(name, ms, float): &(&str, f64, u64)| Pass {
            name: name.to_string(),
            count: 1,
            ms,
            share: 0.5,
            gap_ms: 0.0,
            start_ms: 0.0,
            invocations: None,
            work: Some(Work { float, ..Work::default() }),
            of_peak: Some(Peaks::default()),
        };
        let profile = Profile {
            backend: backend.to_string(),
            variant: "subgroup".to_string(),
            model: "flat".to_string(),
            particles: 512,
            views: 4,
            width: 640,
            height: 480,
            ms: passes.iter().map(|pass| pass.1).sum(),
            gaps_ms: 0.0,
            passes: passes.iter().map(pass).collect(),
        };
        ProfileReport {
            machine: "a machine".to_string(),
            device: "a device".to_string(),
            peaks: Peaks::default(),
            profiles: vec![profile],
            compiled: Vec::new(),
            unavailable: Vec::new(),
        }
    }

    #[test]
    fn passes_stand_beside_each_other_by_name() {
        let before = report("compute", &[("pose", 1.0, 10), ("raster", 4.0, 100), ("old", 1.0, 1)]);
        let now = report("compute", &[("pose", 1.0, 10), ("raster", 2.0, 50), ("new", 1.0, 1)]);
        let text = Comparison { before: &before, now: &now }.to_string();
        let row = |name: &str| -> Vec<String> {
            let line = text.lines().find(|line| line.starts_with(name)).unwrap();
            line[26..].split_whitespace().map(str::to_string).collect()
        };
        assert_eq!(row("an iteration"), ["6.000", "4.000", "0.667"]);
        assert_eq!(row("raster"), ["4.000", "2.000", "0.500", "-", "0.500", "-"]);
        assert_eq!((row("new"), row("old")), (vec!["-".into(), "1.000".into()], vec!["1.000".into(), "-".into()]));
        let other = report("graphics", &[("draw", 1.0, 1)]);
        let text = Comparison { before: &before, now: &other }.to_string();
        assert!(
            text.contains("graphics subgroup: flat model, 512 particles, 4 cameras of 640x480: only now"),
            "{text}"
        );
        assert!(text.contains("640x480: only before"), "{text}");
    }

    #[test]
    fn a_report_is_read_as_it_was_written_and_others_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile.json");
        let report = report("compute", &[("pose", 1.25, 10)]);
        std::fs::write(&path, serde_json::to_string_pretty(&report).unwrap()).unwrap();
        assert_eq!(ProfileReport::read(&path).unwrap(), report);
        std::fs::write(&path, "{\"machine\": 3}").unwrap();
        let error = format!("{:#}", ProfileReport::read(&path).unwrap_err());
        assert!(error.contains("profile.json: expected a profile of pantin bench --profile --json: "), "{error}");
        assert!(error.contains("line 1"), "{error}");
    }
}
