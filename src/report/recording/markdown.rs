//! The report's texts and tables as Markdown.

use std::fmt::Write as _;

use anyhow::Result;

use crate::report::html::ReportData;

/// Headlines, warnings, the error of every joint and the time of every stage.
pub(super) fn summary(data: &ReportData) -> Result<String> {
    let mut text = format!("# {}\n\n{}\n", escape(&data.title), escape(&data.subtitle));
    for headline in &data.headlines {
        write!(text, "\n- **{}** {}", escape(&headline.value), escape(&headline.label))?;
    }
    for (heading, sentences) in [("Warnings", &data.warnings), ("Notes", &data.notes)] {
        if !sentences.is_empty() {
            write!(text, "\n\n## {heading}\n")?;
        }
        for sentence in sentences {
            write!(text, "\n- {}", escape(sentence))?;
        }
    }
    if !data.joint_errors.is_empty() {
        text.push_str("\n\n## Error a joint\n\n| joint | mean, mm | deviation | largest |\n|---|--:|--:|--:|\n");
    }
    for joint in &data.joint_errors {
        let (name, mean, deviation, largest) = (escape(&joint.name), joint.mean, joint.deviation, joint.largest);
        writeln!(text, "| {name} | {mean:.1} | {deviation:.1} | {largest:.1} |")?;
    }
    if !data.stages.is_empty() {
        text.push_str("\n\n## Time a frame\n\n| stage | ms |\n|---|--:|\n");
    }
    for stage in &data.stages {
        writeln!(text, "| {} | {:.2} |", escape(&stage.name), stage.ms)?;
    }
    text.push('\n');
    Ok(text)
}

/// Every setting with its value.
pub(super) fn settings(data: &ReportData) -> String {
    let rows = data.settings.iter().map(|(name, value)| format!("| {} | {} |\n", escape(name), escape(value)));
    std::iter::once("| setting | value |\n|---|---|\n".to_string()).chain(rows).collect()
}

/// Text that stays text: Markdown takes any punctuation behind a backslash as it is.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii_punctuation() {
            out.push('\\');
        }
        out.push(if c.is_control() { ' ' } else { c });
    }
    out
}
