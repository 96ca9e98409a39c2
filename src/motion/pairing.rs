//! Which points of two trajectories are the same, by name and by a map.

use std::collections::{HashMap, HashSet};

use anyhow::{Result, bail, ensure};

use super::joint_names::{Joint, are_joints, joint};
use super::points::PointTrajectory;
use crate::files::{listed, nearest, shortened};

/// Which of our points stands for which point of the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct PointPairs {
    /// Columns of the truth and of ours, in the order of the truth.
    columns: Vec<(usize, usize)>,
    /// Points of the truth that ours has no partner for.
    pub missing_in_ours: Vec<String>,
    /// Points of ours that the truth has no partner for.
    pub missing_in_truth: Vec<String>,
}

impl PointPairs {
    /// Pairs points of equal name, and those that `map` (truth's name, our name) says, before that. Without a map also joints that go by
    /// names of different programs (`RKnee` and `right_knee`): a map says which of such are meant, and the bones of skeletons for animation
    /// (BVH) are called alike and lie elsewhere.
    ///
    /// # Errors
    /// When a name of the map is unknown or stands twice, or when there is no pair at all: the sentence names some
    /// points of both.
    pub fn find(ours: &PointTrajectory, truth: &PointTrajectory, map: &[(String, String)]) -> Result<Self> {
        for (theirs, mine) in map {
            known(truth, theirs, "the truth")?;
            known(ours, mine, "the track")?;
            let uses = |name: &String| map.iter().filter(|(a, b)| a == name || b == name).count();
            ensure!(
                map.iter().filter(|(a, _)| a == theirs).count() == 1
                    && map.iter().filter(|(_, b)| b == mine).count() == 1,
                "the map names `{}` twice, expected every point once",
                if uses(theirs) > 1 { theirs } else { mine }
            );
        }
        let columns: HashMap<&str, usize> =
            ours.names.iter().enumerate().map(|(column, name)| (name.as_str(), column)).collect();
        let column = |name: &String| columns.get(name.as_str()).copied();
        let mapped: HashSet<&str> = map.iter().map(|(_, mine)| mine.as_str()).collect();
        let partner = |name: &String| match map.iter().find(|(theirs, _)| theirs == name) {
            Some((_, mine)) => column(mine),
            // A point of ours that the map gave to another is not free for its namesake.
            None => column(name).filter(|_| !mapped.contains(name.as_str())),
        };
        let by_name: Vec<Option<usize>> = truth.names.iter().map(partner).collect();
        let taken: HashSet<usize> = by_name.iter().copied().flatten().collect();
        // Names that are several joints' on a side stand for none.
        let meant = |names: &[String]| -> HashMap<Joint, Option<usize>> {
            let mut meant = HashMap::new();
            for (column, name) in names.iter().enumerate() {
                if let Some(joint) = joint(name) {
                    meant.entry(joint).and_modify(|only| *only = None).or_insert(Some(column));
                }
            }
            meant
        };
        let (ours_meant, truth_meant) = (meant(&ours.names), meant(&truth.names));
        let has_namesakes = map.is_empty() && are_joints(&truth.names) && are_joints(&ours.names);
        let namesake = |name: &String| {
            let joint = joint(name).filter(|_| has_namesakes)?;
            truth_meant.get(&joint).copied().flatten()?;
            ours_meant.get(&joint).copied().flatten().filter(|column| !taken.contains(column))
        };
        let columns: Vec<(usize, usize)> = by_name
            .iter()
            .zip(&truth.names)
            .enumerate()
            .filter_map(|(column, (partner, name))| Some((column, partner.or_else(|| namesake(name))?)))
            .collect();
        if columns.is_empty() {
            bail!(
                "the truth and the track share no point name: the truth has {}, the track has {}; a map can pair them",
                some_of(&truth.names),
                some_of(&ours.names)
            );
        }
        let paired_truth: HashSet<usize> = columns.iter().map(|pair| pair.0).collect();
        let paired_ours: HashSet<usize> = columns.iter().map(|pair| pair.1).collect();
        Ok(Self {
            missing_in_ours: others(&truth.names, &paired_truth),
            missing_in_truth: others(&ours.names, &paired_ours),
            columns,
        })
    }

    /// Keeps the pairs that `names` lists, by the truth's or our name.
    ///
    /// # Errors
    /// When a name belongs to no pair.
    pub fn keep(&mut self, ours: &PointTrajectory, truth: &PointTrajectory, names: &[String]) -> Result<()> {
        let is =
            |&(theirs, mine): &(usize, usize), name: &String| truth.names[theirs] == *name || ours.names[mine] == *name;
        for name in names {
            ensure!(!name.is_empty(), "a name of points is empty, expected a point's name");
            if !self.columns.iter().any(|pair| is(pair, name)) {
                bail!("there is no point `{name}` to compare, expected some of {}", self.some(truth));
            }
        }
        self.columns.retain(|pair| names.iter().any(|name| is(pair, name)));
        Ok(())
    }

    /// Drops the pairs that a word of `words` belongs to: every point whose name, the truth's or ours, holds the word
    /// in any case; a plural stands for its singular, so `hips` drops `LHip` and `right_hip`.
    ///
    /// # Errors
    /// When a word belongs to no pair, or when no pair is left.
    pub fn exclude(&mut self, ours: &PointTrajectory, truth: &PointTrajectory, words: &[String]) -> Result<()> {
        let named = |&(theirs, mine): &(usize, usize), word: &String| {
            let word = word.to_lowercase();
            let singular = word.strip_suffix('s').filter(|rest| !rest.is_empty()).unwrap_or(&word);
            [&truth.names[theirs], &ours.names[mine]].iter().any(|name| name.to_lowercase().contains(singular))
        };
        for word in words {
            ensure!(!word.is_empty(), "a name to exclude is empty, expected a point's name");
            if !self.columns.iter().any(|pair| named(pair, word)) {
                bail!("there is no point `{word}` to exclude, expected some of {}", self.some(truth));
            }
        }
        self.columns.retain(|pair| !words.iter().any(|word| named(pair, word)));
        ensure!(!self.columns.is_empty(), "every point is excluded, expected one to compare");
        Ok(())
    }

    /// Columns of the truth and of ours, in the order of the truth.
    pub(super) fn columns(&self) -> &[(usize, usize)] {
        &self.columns
    }

    fn some(&self, truth: &PointTrajectory) -> String {
        some_of(&self.columns.iter().map(|pair| truth.names[pair.0].clone()).collect::<Vec<_>>())
    }
}

fn known(points: &PointTrajectory, name: &str, whose: &str) -> Result<()> {
    if points.column(name).is_none() {
        let nearest = nearest(name, points.names.iter().map(String::as_str)).unwrap_or_default();
        bail!("{whose} has no point `{name}`, the nearest name is `{nearest}`");
    }
    Ok(())
}

fn others(names: &[String], paired: &HashSet<usize>) -> Vec<String> {
    names.iter().enumerate().filter(|(column, _)| !paired.contains(column)).map(|(_, name)| name.clone()).collect()
}

fn some_of(names: &[String]) -> String {
    listed(names.iter().map(|name| format!("`{}`", shortened(name))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::test_points::trajectory;

    #[test]
    fn names_are_paired_mapped_kept_and_excluded() {
        let mut truth = trajectory(60.0, 0, 3);
        truth.names = vec!["LHip".into(), "Nose".into()];
        let mut ours = truth.clone();
        ours.names = vec!["hip_of_left".into(), "nose_tip".into()];
        let message = |result: Result<PointPairs>| result.unwrap_err().to_string();
        let none = message(PointPairs::find(&ours, &truth, &[]));
        assert!(none.contains("`LHip`, `Nose`") && none.contains("`hip_of_left`"), "{none}");
        let pair = |a: &str, b: &str| (a.to_string(), b.to_string());
        let map = [pair("LHip", "hip_of_left")];
        let one = PointPairs::find(&ours, &truth, &map).unwrap();
        assert_eq!(
            (one.missing_in_ours.as_slice(), one.missing_in_truth.as_slice()),
            (&["Nose".to_string()][..], &["nose_tip".to_string()][..])
        );
        let wrong = message(PointPairs::find(&ours, &truth, &[pair("LHipp", "hip_of_left")]));
        assert!(wrong.contains("no point `LHipp`, the nearest name is `LHip`"), "{wrong}");
        let wrong =
            message(PointPairs::find(&ours, &truth, &[pair("LHip", "hip_of_left"), pair("Nose", "hip_of_left")]));
        assert!(wrong.contains("`hip_of_left` twice"), "{wrong}");

        let map = [pair("LHip", "hip_of_left"), pair("Nose", "nose_tip")];
        let both = PointPairs::find(&ours, &truth, &map).unwrap();
        let names = |words: &[&str]| words.iter().map(|w| (*w).to_string()).collect::<Vec<_>>();
        let mut kept = both.clone();
        kept.keep(&ours, &truth, &names(&["nose_tip"])).unwrap();
        assert_eq!(kept.columns, [(1, 1)]);
        assert!(kept.keep(&ours, &truth, &names(&["knee"])).unwrap_err().to_string().contains("no point `knee`"));
        let mut left = both.clone();
        left.exclude(&ours, &truth, &names(&["hips"])).unwrap();
        assert_eq!(left.columns, [(1, 1)]);
        let mut nothing = both.clone();
        let wrong = nothing.exclude(&ours, &truth, &names(&["nose", "HIP"])).unwrap_err().to_string();
        assert!(wrong.contains("every point is excluded"), "{wrong}");
        let wrong = both.clone().exclude(&ours, &truth, &names(&["knees"])).unwrap_err().to_string();
        assert!(wrong.contains("no point `knees`"), "{wrong}");
    }

    #[test]
    fn joints_of_other_programs_are_paired() {
        let mut truth = trajectory(60.0, 0, 3);
        let ours = PointTrajectory { names: vec!["right_knee".into(), "head_top".into()], ..truth.clone() };
        let pairs = |truth: &PointTrajectory| PointPairs::find(&ours, truth, &[]).map(|pairs| pairs.columns);
        truth.names = vec!["Head".into(), "RKnee".into()];
        assert_eq!(pairs(&truth).unwrap(), [(0, 1), (1, 0)]);
        // Its own name comes first, and what two points could be is neither.
        truth.names = vec!["RKnee".into(), "right_knee".into()];
        assert_eq!(pairs(&truth).unwrap(), [(1, 0)]);
        truth.names = vec!["RKnee".into(), "R_Knee".into()];
        assert!(pairs(&truth).is_err());
        truth.names = vec!["LKnee".into(), "RKNE".into()];
        assert!(pairs(&truth).is_err());
        // In a BVH that is the collar bone.
        truth.names = vec!["RightKnee".into(), "RightArm".into()];
        assert!(pairs(&truth).is_err());
        // A map names all that are meant.
        truth.names = vec!["Head".into(), "RKnee".into()];
        let mapped = PointPairs::find(&ours, &truth, &[("Head".into(), "head_top".into())]).unwrap();
        assert_eq!(mapped.columns, [(0, 1)]);
    }

    #[test]
    fn a_mapped_point_is_not_used_twice() {
        let truth = trajectory(60.0, 0, 3);
        let pairs = PointPairs::find(&truth, &truth, &[("a".into(), "b".into())]).unwrap();
        assert_eq!(pairs.columns, [(0, 1)], "b of ours stands for a, so the truth's b has no partner");
    }
}
