//! XML as calibrations have it. The parser compares every attribute of an element with those before it, and hands every namespace on to the
//! elements below, so the time that a hostile file takes grows as the square of them: they are counted first.

use anyhow::{Result, anyhow, ensure};
use roxmltree::Document;

/// No element of a calibration has more attributes.
const MOST_ATTRIBUTES: usize = 256;
/// No calibration declares more namespaces.
const MOST_NAMESPACES: usize = 64;

/// Parses a file; `name` stands for it in messages.
///
/// # Errors
/// One sentence with the file and the line, for what is no XML and for more attributes and namespaces than calibrations have.
pub(super) fn parse_xml<'a>(text: &'a str, name: &str) -> Result<Document<'a>> {
    count_attributes(text, name)?;
    // The parser quotes what it met, line ends too.
    Document::parse(text).map_err(|error| anyhow!("{name} is not XML: {}", error.to_string().replace('\n', "\\n")))
}

fn count_attributes(text: &str, name: &str) -> Result<()> {
    let line = |at: usize| text.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
    let mut namespaces = 0;
    let mut at = 0;
    while let Some(found) = text[at..].find('<') {
        let begin = at + found;
        let rest = &text[begin..];
        let ends = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, end)) = ends.into_iter().find(|(mark, _)| rest.starts_with(mark)) {
            let Some(length) = rest.find(end) else { return Ok(()) };
            at = begin + length;
            continue;
        }
        let (mut quote, mut attributes, mut length) = (None, 0, rest.len());
        for (place, byte) in rest.bytes().enumerate() {
            match (quote, byte) {
                (None, b'"' | b'\'') => quote = Some(byte),
                (Some(open), byte) if open == byte => quote = None,
                (None, b'=') => attributes += 1,
                (None, b'>') => {
                    length = place;
                    break;
                }
                _ => {}
            }
            if quote.is_none() && rest.as_bytes()[place..].starts_with(b"xmlns") {
                namespaces += 1;
            }
            ensure!(
                attributes <= MOST_ATTRIBUTES,
                "{name}, line {}: an element has more than {MOST_ATTRIBUTES} attributes, expected a calibration",
                line(begin)
            );
        }
        ensure!(
            namespaces <= MOST_NAMESPACES,
            "{name}, line {}: there are more than {MOST_NAMESPACES} namespaces, expected a calibration",
            line(begin)
        );
        at = begin + length;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_counted_before_they_are_compared() {
        let many = |count: usize| (0..count).map(|index| format!(" a{index}='>'")).collect::<String>();
        let file =
            |count: usize| format!("<?xml version='1.0'?>\n<!-- a ' < = -->\n<a b=\"<\"><c{}/></a>", many(count));
        let error = |text: &str| parse_xml(text, "c.xml").unwrap_err().to_string();
        parse_xml(&file(200).replace("\"<\"", "\"\""), "c.xml").unwrap();
        let begin = std::time::Instant::now();
        assert!(error(&file(100_000)).starts_with("c.xml, line 3: an element has more than 256 attributes"));
        let spaces: String = (0..1000).map(|index| format!("<a xmlns:n{index}='u'>")).collect();
        assert!(error(&spaces).starts_with("c.xml, line 1: there are more than 64 namespaces"), "{}", error(&spaces));
        assert!(begin.elapsed().as_secs() < 5);
        for text in ["<", "<a", "<!--", "<a b='", "<?", "a<b=c=d", "", "<é>"] {
            assert!(error(text).starts_with("c.xml is not XML"), "{text}");
        }
    }
}
