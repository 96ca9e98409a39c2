//! The results for people.

use std::fmt::{self, Display, Formatter};

use super::report::SweepReport;

impl Display for SweepReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { machine, device, particles, views, width, height, .. } = self;
        writeln!(f, "machine: {machine}\ndevice:  {device}")?;
        writeln!(
            f,
            "\n{particles} particles, {views} cameras of {width}x{height}: ms of a stage in an iteration (median, shortest, longest), \
             and times the shortest median of the stage; * is taken unasked"
        )?;
        let mut stage = "";
        for row in &self.rows {
            if row.stage != stage {
                stage = &row.stage;
                writeln!(f, "\n{stage:34} {:>9} {:>9} {:>9} {:>9} {:>7}", "workgroup", "ms", "min", "max", "times")?;
            }
            let least = self.rows.iter().filter(|other| other.stage == row.stage).map(|other| other.ms);
            let least = least.fold(f64::INFINITY, f64::min);
            writeln!(
                f,
                "  {:32} {:>8}{} {:9.3} {:9.3} {:9.3} {:7.2}",
                row.way,
                row.workgroup,
                if row.usual { '*' } else { ' ' },
                row.ms,
                row.ms_min,
                row.ms_max,
                row.ms / least
            )?;
        }
        if !self.unavailable.is_empty() {
            writeln!(f, "\nNot measured here:")?;
        }
        self.unavailable.iter().try_for_each(|why| writeln!(f, "  {why}"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::report::tests::report;

    #[test]
    fn a_table_says_what_is_fastest_and_what_is_taken() {
        let text = report().to_string();
        let line = |head: &str| text.lines().find(|line| line.trim_start().starts_with(head)).unwrap().to_string();
        assert!(line("3 words").contains("32*") && line("3 words").ends_with("1.25"), "{text}");
        assert!(line("4 words").ends_with("1.00"), "{text}");
        assert!(text.contains("Not measured here:\n  compare, texels by 512: too many"), "{text}");
    }
}
