//! Which parts look alike: groups of parts by name, joined by colour until a pixel has room for the classes.

use anyhow::Result;

use super::colours::Colours;
use crate::body::{Body, without_side};
use crate::features::PartClasses;

/// Groups joined because they look alike whatever their number: nearly the same colours.
const ALIKE: f32 = 0.9;
/// Pixels below which a group's colours say nothing yet.
const SEEN: f32 = 30.0;

/// The parts of a body, left and right together.
#[derive(Clone, Debug)]
pub(super) struct Groups {
    labels: Vec<Vec<u8>>,
    /// The group of each label.
    of_label: [Option<u8>; 128],
}

impl Groups {
    pub(super) fn of(body: &Body) -> Self {
        let mut names: Vec<&str> = Vec::new();
        let mut labels: Vec<Vec<u8>> = Vec::new();
        let mut of_label = [None; 128];
        for part in &body.parts {
            let name = without_side(&part.name);
            let group = names.iter().position(|known| *known == name).unwrap_or_else(|| {
                names.push(name);
                labels.push(Vec::new());
                names.len() - 1
            });
            labels[group].push(part.label);
            of_label[usize::from(part.label & 0x7f)] = u8::try_from(group).ok();
        }
        Self { labels, of_label }
    }

    pub(super) fn count(&self) -> usize {
        self.labels.len()
    }

    /// The group of a drawn byte's label; none where nothing is drawn.
    pub(super) fn of_label(&self, byte: u8) -> Option<usize> {
        self.of_label[usize::from(byte & 0x7f)].map(usize::from)
    }
}

/// The classes that groups of these colours make, and the class of each group: the two that look most alike are joined, again and again,
/// while they are nearly the same or more than there may be.
pub(super) fn grouped(groups: &Groups, seen: &[Colours]) -> Result<(PartClasses, Vec<u8>)> {
    let mut members: Vec<(Vec<usize>, Colours)> =
        seen.iter().enumerate().map(|(group, colours)| (vec![group], colours.clone())).collect();
    while members.len() > 1 {
        let mut alike = (f32::NEG_INFINITY, 0, 1);
        for one in 0..members.len() {
            for other in one + 1..members.len() {
                let [a, b] = [&members[one].1, &members[other].1];
                // What was hardly seen is a class of its own, which looks like the whole person.
                let likeness = match [a, b].map(|colours| colours.total() < SEEN) {
                    [false, false] => a.likeness(b),
                    [true, true] => 1.0,
                    _ => -1.0,
                };
                if likeness > alike.0 {
                    alike = (likeness, one, other);
                }
            }
        }
        let (likeness, one, other) = alike;
        if likeness < ALIKE && members.len() <= PartClasses::MOST {
            break;
        }
        let (joined, colours) = members.remove(other);
        members[one].0.extend(joined);
        members[one].1.join(&colours);
    }
    let mut of_group = vec![0; groups.count()];
    for (class, (joined, _)) in members.iter().enumerate() {
        joined.iter().for_each(|&group| of_group[group] = class as u8);
    }
    let labels = groups.labels.iter().zip(&of_group);
    let classes =
        PartClasses::new(labels.flat_map(|(labels, &class)| labels.iter().map(move |&label| (label, class))))?;
    Ok((classes, of_group))
}
