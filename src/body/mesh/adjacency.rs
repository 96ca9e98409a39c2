//! The edges of a closed mesh, each with its two triangles.

use std::collections::HashMap;

use anyhow::{Result, bail, ensure};

/// An edge of a [`super::Mesh`] and the third vertices of its two triangles, which are `(ends[0], ends[1], opposite[0])` and
/// `(ends[1], ends[0], opposite[1])`. It is a silhouette edge where exactly one of them faces the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshEdge {
    /// The vertices it joins, the smaller index first.
    pub ends: [u32; 2],
    /// The third vertex of either triangle.
    pub opposite: [u32; 2],
}

/// The edges of a closed, consistently oriented surface, ordered by their ends.
///
/// # Errors
/// When an index is out of range, a triangle has a vertex twice, or an edge does not have exactly two triangles running
/// through it in opposite directions; the edge is named.
pub(super) fn edges(triangles: &[[u32; 3]], vertex_count: usize) -> Result<Vec<MeshEdge>> {
    // The vertex opposite each directed edge.
    let mut opposite: HashMap<[u32; 2], u32> = HashMap::with_capacity(triangles.len() * 3);
    for (index, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = *triangle;
        if let Some(vertex) = triangle.iter().find(|vertex| **vertex as usize >= vertex_count) {
            bail!("triangle {index} names vertex {vertex}, there are {vertex_count}");
        }
        ensure!(
            a != b && b != c && c != a,
            "triangle {index} has the vertices {a}, {b}, {c}, expected three different"
        );
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            if opposite.insert([from, to], third).is_some() {
                bail!(
                    "two triangles run from vertex {from} to {to}, expected each edge to have two triangles of opposite directions"
                );
            }
        }
    }
    let mut edges = Vec::with_capacity(opposite.len() / 2);
    for (&[from, to], &third) in &opposite {
        let Some(&other) = opposite.get(&[to, from]) else {
            bail!("the edge from vertex {from} to {to} has a triangle on one side alone, expected a closed surface");
        };
        if from < to {
            edges.push(MeshEdge { ends: [from, to], opposite: [third, other] });
        }
    }
    // Out of the hash map's order, which differs from run to run.
    edges.sort_unstable_by_key(|edge| edge.ends);
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_tetrahedron_has_six_edges_each_between_its_two_triangles() {
        let edges = edges(&TETRAHEDRON, 4).unwrap();
        let ends: Vec<[u32; 2]> = edges.iter().map(|edge| edge.ends).collect();
        assert_eq!(ends, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]);
        assert_eq!(edges[0].opposite, [3, 2]);
        for edge in &edges {
            for (triangle, from, to) in
                [(edge.opposite[0], edge.ends[0], edge.ends[1]), (edge.opposite[1], edge.ends[1], edge.ends[0])]
            {
                let turns = [[from, to, triangle], [to, triangle, from], [triangle, from, to]];
                assert!(TETRAHEDRON.iter().any(|known| turns.contains(known)), "{edge:?}");
            }
        }
    }

    #[test]
    fn a_surface_that_is_none_is_refused_and_the_place_named() {
        let mut flipped = TETRAHEDRON;
        flipped[3] = [0, 2, 3];
        let mut third = TETRAHEDRON.to_vec();
        third.push([0, 2, 1]);
        for (triangles, sentence) in [
            (TETRAHEDRON[..3].to_vec(), "one side alone, expected a closed surface"),
            (flipped.to_vec(), "expected each edge to have two triangles of opposite directions"),
            (third, "two triangles run from vertex 0 to 2"),
            (vec![[0, 1, 4]], "triangle 0 names vertex 4, there are 4"),
            (vec![[0, 1, 1]], "triangle 0 has the vertices 0, 1, 1"),
        ] {
            let error = edges(&triangles, 4).unwrap_err().to_string();
            assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
        }
    }
}
