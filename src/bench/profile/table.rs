//! A profile for people.

use std::fmt::{self, Display, Formatter};

use super::report::{Pass, Profile, ProfileReport};

impl Display for ProfileReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "machine: {}", self.machine)?;
        writeln!(f, "device:  {}", self.device)?;
        writeln!(
            f,
            "peaks:   {:.1} G integer operations/s, {:.1} G in floating point, {:.1} GB/s of memory, {:.1} GB/s of shared memory",
            self.peaks.integer * 1e-9,
            self.peaks.float * 1e-9,
            self.peaks.memory * 1e-9,
            self.peaks.shared * 1e-9
        )?;
        for profile in &self.profiles {
            of_profile(f, profile)?;
        }
        writeln!(
            f,
            "\nM: millions an iteration. Operations and bytes are those of the code, counted block by block while it ran; what caches\n\
             catch counts too, so memory can exceed its peak. Fills, copies and the fixed parts of the graphics pipeline (blending,\n\
             depth, rasterising) do work that is not counted."
        )?;
        if self.compiled.is_empty() {
            writeln!(f, "The driver does not tell registers and spills (VK_KHR_pipeline_executable_properties).")?;
        } else {
            writeln!(f, "\nAs the driver compiled them:")?;
        }
        for stage in &self.compiled {
            let told: Vec<String> = stage.statistics.iter().map(|one| format!("{} {}", one.name, one.value)).collect();
            let told = told.join(", ");
            writeln!(f, "  {} ({}, subgroups of {}): {told}", stage.pipeline, stage.stage, stage.subgroup_size)?;
        }
        if !self.unavailable.is_empty() {
            writeln!(f, "\nNot measured here:")?;
        }
        for missing in &self.unavailable {
            writeln!(f, "  {missing}")?;
        }
        Ok(())
    }
}

fn of_profile(f: &mut Formatter<'_>, profile: &Profile) -> fmt::Result {
    let Profile { ms, gaps_ms, passes, .. } = profile;
    let busy: f64 = passes.iter().map(|pass| pass.ms).sum();
    writeln!(f, "\n{}\n{ms:.3} ms an iteration; passes {busy:.3} ms, {gaps_ms:.3} ms between them", profile.title())?;
    writeln!(
        f,
        "{:26} {:>9} {:>6} {:>7} {:>12} {:>9} {:>9} {:>8} {:>8} | {:>5} {:>5} {:>6} {:>6}",
        "pass",
        "ms",
        "share",
        "gap",
        "invocations",
        "M int",
        "M float",
        "M B mem",
        "M B shr",
        "int",
        "float",
        "memory",
        "shared"
    )?;
    passes.iter().try_for_each(|pass| line(f, pass))
}

fn line(f: &mut Formatter<'_>, pass: &Pass) -> fmt::Result {
    let name = if pass.count > 1 { format!("{} x {}", pass.name, pass.count) } else { pass.name.clone() };
    let invocations = pass.invocations.map_or_else(
        || "-".to_string(),
        |all| match (all.compute, all.fragments) {
            (0, 0) => all.vertices.to_string(),
            (0, fragments) => fragments.to_string(),
            (compute, _) => compute.to_string(),
        },
    );
    write!(f, "{name:26} {:9.3} {:5.1}% {:7.3} {invocations:>12}", pass.ms, pass.share * 100.0, pass.gap_ms)?;
    let (Some(work), Some(part)) = (&pass.work, &pass.of_peak) else { return writeln!(f) };
    let millions = |number: u64| number as f64 * 1e-6;
    writeln!(
        f,
        " {:9.2} {:9.2} {:8.2} {:8.2} | {:4.0}% {:4.0}% {:5.0}% {:5.0}%",
        millions(work.integer),
        millions(work.float),
        millions(work.memory()),
        millions(work.shared),
        part.integer * 100.0,
        part.float * 100.0,
        part.memory * 100.0,
        part.shared * 100.0
    )
}
