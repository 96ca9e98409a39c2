//! The results for people.

use std::fmt::{self, Display, Formatter};

use super::report::{BenchReport, Row};
use super::thesis;

impl Display for BenchReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "machine: {}", self.machine)?;
        writeln!(f, "device:  {}", self.device.as_deref().unwrap_or("none"))?;
        let mut task = None;
        for row in &self.rows {
            let own = (row.width, row.height, row.particles, row.model.as_str());
            if task != Some(own) {
                task = Some(own);
                head(f, row)?;
            }
            line(f, row)?;
        }
        writeln!(f)?;
        for note in thesis::NOTES {
            writeln!(f, "{note}")?;
        }
        if !self.unavailable.is_empty() {
            writeln!(f, "\nNot measured here:")?;
        }
        for missing in &self.unavailable {
            let name = format!("{} {}", missing.backend, missing.variant);
            writeln!(f, "  {} ({}): {}", name.trim_end(), missing.model, missing.reason)?;
        }
        Ok(())
    }
}

fn head(f: &mut Formatter<'_>, row: &Row) -> fmt::Result {
    writeln!(
        f,
        "\n{} model, {} particles, {} cameras of {}x{}: ms an iteration (median, shortest, longest)",
        row.model, row.particles, row.views, row.width, row.height
    )?;
    write!(
        f,
        "{:34} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>7} {:>9}",
        "backend", "ms", "min", "max", "poses/s", "images/s", "Mpix/s", "B/pixel", "tile"
    )?;
    if thesis::times(&row.model, row.particles, [row.width, row.height]).is_some() {
        write!(f, "  |")?;
        for name in thesis::COLUMNS {
            write!(f, " {name:>9}")?;
        }
    } else if thesis::ladder(&row.model, row.particles).is_some() {
        write!(f, "  | {:>12} {:>9}", "thesis/frame", "its tenth")?;
    }
    writeln!(f)
}

fn line(f: &mut Formatter<'_>, row: &Row) -> fmt::Result {
    let name = format!("{} {}", row.backend, row.variant);
    let bytes = row.bytes_per_pixel.map_or_else(|| "-".to_string(), |bytes| format!("{bytes:.2}"));
    write!(
        f,
        "{:34} {:8.3} {:8.3} {:8.3} {:9.0} {:9.0} {:8.0} {bytes:>7} {:>9}",
        name.trim_end(),
        row.ms,
        row.ms_min,
        row.ms_max,
        row.poses_per_s,
        row.images_per_s,
        row.pixels_per_s * 1e-6,
        format!("{}x{}", row.tile[0], row.tile[1])
    )?;
    if let Some(times) = thesis::times(&row.model, row.particles, [row.width, row.height]) {
        write!(f, "  |")?;
        for ms in times {
            write!(f, " {ms:>9}")?;
        }
    } else if let Some(ms) = thesis::ladder(&row.model, row.particles) {
        write!(f, "  | {ms:>12} {:>9.1}", ms / 10.0)?;
    }
    writeln!(f)?;
    if !row.stages.is_empty() {
        let stages: Vec<String> = row.stages.iter().map(|(name, ms)| format!("{name} {ms:.3}")).collect();
        writeln!(f, "  of which {}", stages.join(", "))?;
    }
    if let Some(wrong) = &row.wrong {
        writeln!(f, "  WRONG: {wrong}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::contestants::{Missing, WrongPixels};
    use super::*;

    fn row(model: &str, size: [u32; 2], particles: usize) -> Row {
        Row {
            backend: "compute".into(),
            variant: "subgroup".into(),
            model: model.into(),
            particles,
            views: 4,
            width: size[0],
            height: size[1],
            tile: [32, 16],
            bytes_per_pixel: None,
            ms: 2.0,
            ms_min: 1.0,
            ms_max: 4.0,
            stages: vec![("pose".into(), 0.25), ("raster".into(), 1.5)],
            poses_per_s: 256e3,
            images_per_s: 1.024e6,
            pixels_per_s: 3.1e11,
            wrong: None,
        }
    }

    #[test]
    fn the_thesis_stands_beside_and_the_missing_below() {
        let wrong =
            WrongPixels { pictures: 4, drawn: 1000, wrong: 125, edges: 50, hidden: 20, with_falling_labels: 250 };
        let wrong = Row { wrong: Some(wrong), ..row("flat", [480, 270], 512) };
        let report = BenchReport {
            preset: "thesis".into(),
            machine: "a machine".into(),
            device: None,
            rows: vec![row("flat", [640, 480], 512), wrong, row("elliptic-514", [640, 480], 304)],
            unavailable: vec![Missing {
                backend: "graphics".into(),
                variant: "shared".into(),
                model: "flat".into(),
                reason: "there is no Vulkan on this machine".into(),
            }],
        };
        let text = report.to_string();
        let lines: Vec<&str> = text.lines().collect();
        let beside: Vec<bool> =
            lines.iter().filter(|line| line.starts_with("compute")).map(|line| line.contains('|')).collect();
        assert_eq!(beside, [true, false, true], "{text}");
        assert!(text.contains("177") && text.contains("8.23") && text.contains("389.6"), "{text}");
        assert!(text.contains("of which pose 0.250, raster 1.500"), "{text}");
        let told = "WRONG: 125 of 1000 pixels (12.5 %) wrong in 4 pictures, 20 of 50 edge pixels (40.0 %) hidden; with labels that fall from part to part 250 (25.0 %) wrong";
        assert_eq!(text.matches(told).count(), 1, "{text}");
        assert!(text.contains("graphics shared (flat): there is no Vulkan on this machine"), "{text}");
    }
}
