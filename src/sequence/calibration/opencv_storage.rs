//! OpenCV's file storage, YAML and XML, as a flat list of keys and values. What other elements a file holds (lists of
//! pictures, points, statistics) is passed over.

use anyhow::{Result, anyhow, bail, ensure};
use roxmltree::Node;
use saphyr_parser::{Event, Parser, Span};

use super::xml::parse_xml;

/// Calibrations are three levels deep; a file built to exhaust memory is much deeper.
const DEEPEST: usize = 16;

/// The keys of a storage.
#[derive(Debug)]
pub(super) struct Storage {
    pub(super) entries: Vec<Entry>,
}

/// A key with its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: String,
    /// Counted from 1.
    pub(super) line: usize,
    pub(super) value: Value,
}

/// A value, as far as calibrations need it.
#[derive(Debug, PartialEq)]
pub(super) enum Value {
    /// A number, or a row of numbers.
    Numbers(Vec<f64>),
    /// A matrix, row by row.
    Matrix { rows: usize, columns: usize, data: Vec<f64> },
    /// Anything else of one piece.
    Text(String),
    /// A structure.
    Other,
}

impl Storage {
    /// Reads OpenCV's XML.
    pub(super) fn from_xml(text: &str, name: &str) -> Result<Self> {
        let document = parse_xml(text, name)?;
        let root = document.root_element();
        ensure!(
            root.has_tag_name("opencv_storage"),
            "{name} has the root element `{}`, expected `opencv_storage`, as OpenCV writes it",
            root.tag_name().name()
        );
        let entries = root.children().filter(Node::is_element).map(|node| {
            let line = document.text_pos_at(node.range().start).row as usize;
            let key = node.tag_name().name().to_string();
            let value = xml_value(node).map_err(|error| anyhow!("{name}, line {line}: {key} {error}"))?;
            Ok(Entry { key, line, value })
        });
        Self { entries: entries.collect::<Result<_>>()? }.without_doubles(name)
    }

    /// Reads OpenCV's YAML, or plain YAML of the same keys.
    pub(super) fn from_yaml(text: &str, name: &str) -> Result<Self> {
        // OpenCV's first line, `%YAML:1.0`, is not YAML; left blank, lines keep their numbers.
        let header = text.starts_with("%YAML").then(|| text.find('\n').unwrap_or(text.len()));
        let mut events = Parser::new_from_str(&text[header.unwrap_or(0)..]);
        let mut entries = None;
        while let Some(event) = events.next() {
            let (event, span) = event.map_err(|error| yaml_error(&error, name))?;
            match event {
                Event::StreamStart | Event::DocumentStart(_) | Event::DocumentEnd | Event::Nothing => {}
                Event::StreamEnd => break,
                event => {
                    let line = span.start.line();
                    ensure!(entries.is_none(), "{name}, line {line}: a second document begins, expected one");
                    let YamlNode::Map(map) = yaml_node(event, span, &mut events, 0, name)? else {
                        bail!("{name}, line {line}: expected `key: value` lines, as OpenCV writes them");
                    };
                    entries = Some(map);
                }
            }
        }
        let entries = entries.unwrap_or_default().into_iter().map(|(key, line, node)| {
            let value = yaml_value(node).map_err(|error| anyhow!("{name}, line {line}: {key} {error}"))?;
            Ok(Entry { key, line, value })
        });
        Self { entries: entries.collect::<Result<_>>()? }.without_doubles(name)
    }

    /// Adds the keys of another file that are not here already.
    pub(super) fn add(&mut self, other: Self) {
        let new = other.entries.into_iter().filter(|entry| self.entries.iter().all(|here| here.key != entry.key));
        let new: Vec<Entry> = new.collect();
        self.entries.extend(new);
    }

    fn without_doubles(self, name: &str) -> Result<Self> {
        let mut seen = std::collections::HashMap::new();
        for Entry { key, line, .. } in &self.entries {
            if let Some(first) = seen.insert(key, line) {
                bail!("{name}, line {line}: {key} was there already on line {first}, expected it once");
            }
        }
        Ok(self)
    }
}

/// A matrix of however many dimensions; those of more than two mean nothing here.
fn nd_matrix(sizes: Option<Vec<f64>>, data: Option<Vec<f64>>) -> Result<Value> {
    match sizes.as_deref() {
        Some(&[length]) => matrix(Some(1.0), Some(length), data),
        Some(&[rows, columns]) => matrix(Some(rows), Some(columns), data),
        _ => Ok(Value::Other),
    }
}

fn matrix(rows: Option<f64>, columns: Option<f64>, data: Option<Vec<f64>>) -> Result<Value> {
    let (Some(rows), Some(columns), Some(data)) = (rows, columns, data) else {
        bail!("is a matrix with a part missing, expected rows, cols and data of numbers");
    };
    // Anything larger than a list of points is of no interest, and its product must not overflow.
    let whole = |side: f64| side.fract() == 0.0 && (0.0..1e9).contains(&side);
    ensure!(whole(rows) && whole(columns), "has rows {rows} and cols {columns}, expected whole numbers");
    // Points and pictures have several channels an element; as a matrix they mean nothing here.
    if data.len() > 64 {
        return Ok(Value::Other);
    }
    ensure!(rows * columns == data.len() as f64, "holds {} numbers, expected {rows} rows of {columns}", data.len());
    Ok(Value::Matrix { rows: rows as usize, columns: columns as usize, data })
}

/// A number as OpenCV writes it: `1.`, `1.5e+03`, `.Nan`, `-.Inf`.
fn number(text: &str) -> Option<f64> {
    let lower = text.to_ascii_lowercase();
    lower.replace(".nan", "nan").replace(".inf", "inf").parse().ok()
}

fn text_value(text: &str) -> Value {
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
    match numbers {
        Some(numbers) if !numbers.is_empty() => Value::Numbers(numbers),
        _ => Value::Text(text.trim().trim_matches('"').to_string()),
    }
}

fn xml_value(node: Node) -> Result<Value> {
    let part = |tag: &str| {
        let text = node.children().find(|child| child.has_tag_name(tag))?.text()?;
        text.split_whitespace().map(number).collect::<Option<Vec<f64>>>()
    };
    if node.attribute("type_id") == Some("opencv-nd-matrix") {
        return nd_matrix(part("sizes"), part("data"));
    }
    let is_matrix = node.attribute("type_id") == Some("opencv-matrix");
    if is_matrix {
        let one = |tag: &str| part(tag).and_then(|numbers| numbers.first().copied());
        return matrix(one("rows"), one("cols"), part("data"));
    }
    if node.children().any(|child| child.is_element()) {
        return Ok(Value::Other);
    }
    Ok(text_value(node.text().unwrap_or_default()))
}

/// A YAML document's tree.
enum YamlNode {
    Scalar(String),
    List(Vec<YamlNode>),
    Map(Vec<(String, usize, YamlNode)>),
}

type Events<'a> = Parser<'a, saphyr_parser::StrInput<'a>>;

fn yaml_node(event: Event, span: Span, events: &mut Events, depth: usize, name: &str) -> Result<YamlNode> {
    let line = span.start.line();
    ensure!(depth <= DEEPEST, "{name}, line {line}: nested deeper than {DEEPEST} levels, expected a calibration");
    match event {
        Event::Scalar(text, ..) => Ok(YamlNode::Scalar(text.into_owned())),
        Event::SequenceStart(..) => {
            let mut list = Vec::new();
            loop {
                match yaml_event(events, name)? {
                    (Event::SequenceEnd, _) => return Ok(YamlNode::List(list)),
                    (event, span) => list.push(yaml_node(event, span, events, depth + 1, name)?),
                }
            }
        }
        Event::MappingStart(..) => {
            let mut map = Vec::new();
            loop {
                match yaml_event(events, name)? {
                    (Event::MappingEnd, _) => return Ok(YamlNode::Map(map)),
                    (Event::Scalar(key, ..), span) => {
                        let (event, value_span) = yaml_event(events, name)?;
                        let value = yaml_node(event, value_span, events, depth + 1, name)?;
                        map.push((key.into_owned(), span.start.line(), value));
                    }
                    (_, span) => {
                        bail!("{name}, line {}: found a structure as a key, expected a word", span.start.line())
                    }
                }
            }
        }
        // An alias may stand for a whole tree, again and again: OpenCV writes none.
        Event::Alias(_) => bail!("{name}, line {line}: found an alias (*), expected the value itself"),
        _ => bail!("{name}, line {line}: the file ends within a structure"),
    }
}

fn yaml_event<'a>(events: &mut Events<'a>, name: &str) -> Result<(Event<'a>, Span)> {
    match events.next() {
        Some(event) => event.map_err(|error| yaml_error(&error, name)),
        None => bail!("{name} ends within a structure"),
    }
}

fn yaml_error(error: &saphyr_parser::ScanError, name: &str) -> anyhow::Error {
    anyhow!("{name}, line {}: not YAML: {}", error.marker().line(), error.info())
}

fn yaml_value(node: YamlNode) -> Result<Value> {
    match node {
        YamlNode::Scalar(text) => Ok(text_value(&text)),
        YamlNode::List(list) => Ok(yaml_list(&list)),
        YamlNode::Map(map) => {
            let part = |wanted: &str| map.iter().find(|(key, ..)| key == wanted).map(|(.., node)| node);
            let numbers = |node: &YamlNode| match node {
                YamlNode::Scalar(text) => number(text).map(|value| vec![value]),
                YamlNode::List(list) => yaml_row(list),
                YamlNode::Map(_) => None,
            };
            if part("rows").is_none() || part("cols").is_none() {
                return nd_matrix(part("sizes").and_then(numbers), part("data").and_then(numbers));
            }
            let one = |key: &str| part(key).and_then(numbers).and_then(|numbers| numbers.first().copied());
            matrix(one("rows"), one("cols"), part("data").and_then(numbers))
        }
    }
}

fn yaml_row(list: &[YamlNode]) -> Option<Vec<f64>> {
    let numbers = list.iter().map(|node| match node {
        YamlNode::Scalar(text) => number(text),
        _ => None,
    });
    numbers.collect()
}

/// A list of numbers, or one of equally long rows, as people write matrices by hand.
fn yaml_list(list: &[YamlNode]) -> Value {
    if let Some(numbers) = yaml_row(list) {
        return Value::Numbers(numbers);
    }
    let rows: Option<Vec<Vec<f64>>> = list
        .iter()
        .map(|node| match node {
            YamlNode::List(row) => yaml_row(row),
            _ => None,
        })
        .collect();
    match rows {
        Some(rows) if rows.iter().all(|row| row.len() == rows[0].len()) => {
            Value::Matrix { rows: rows.len(), columns: rows[0].len(), data: rows.concat() }
        }
        _ => Value::Other,
    }
}
