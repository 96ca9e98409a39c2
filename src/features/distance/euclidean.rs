//! Squared Euclidean distances in linear time: how far the nearest edge is in each column, then along each row the lower
//! envelope of the parabolas that these distances are the vertices of.
//!
//! Why that is exact: (x - i)² + g(i)² with g(i) the vertical distance in column i is the squared distance to the nearest
//! edge pixel of that column, so the smallest over all i is the squared distance to the nearest edge of all. Where two
//! such parabolas cross is found by a division of whole numbers that rounds down, so that no pixel is ever given to
//! the wrong one; nothing is rounded anywhere else.

/// Scratch rows, kept between frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Envelope {
    /// Columns whose parabolas are part of the envelope, left to right.
    vertices: Vec<u32>,
    /// The first column where each of them is the lowest.
    starts: Vec<u32>,
    /// The vertical distances of the row at hand.
    row: Vec<u32>,
}

impl Envelope {
    /// Turns `values` (0 on edges, `limit` squared everywhere else) into `min(d², limit²)` in the columns `x0..x1` and the rows
    /// `y0..y1` of a picture `width` wide.
    pub(super) fn squared(
        &mut self,
        values: &mut [u32],
        width: usize,
        [x0, x1]: [usize; 2],
        [y0, y1]: [usize; 2],
        limit: u32,
    ) {
        // Vertical distances, down and up; farther than the limit is no better than the limit.
        for value in &mut values[y0 * width..][x0..x1] {
            *value = (*value).min(limit);
        }
        for y in y0 + 1..y1 {
            let (before, from_here) = values.split_at_mut(y * width);
            farther(&mut from_here[x0..x1], &before[(y - 1) * width..][x0..x1], limit);
        }
        for y in (y0..y1.saturating_sub(1)).rev() {
            let (to_here, after) = values.split_at_mut((y + 1) * width);
            farther(&mut to_here[y * width..][x0..x1], &after[x0..x1], limit);
        }
        for y in y0..y1 {
            self.row(&mut values[y * width..][x0..x1], limit);
        }
    }

    /// One row of vertical distances to squared distances.
    fn row(&mut self, values: &mut [u32], limit: u32) {
        self.row.clear();
        self.row.extend_from_slice(values);
        self.vertices.clear();
        self.starts.clear();
        let square = |g: u32| i64::from(g) * i64::from(g);
        for (column, &g) in (0_u32..).zip(&self.row) {
            // A column without an edge within the limit bears no parabola.
            if g >= limit {
                continue;
            }
            let mut start = 0;
            while let (Some(&last), Some(&since)) = (self.vertices.last(), self.starts.last()) {
                // The first whole column where the new parabola is lower than the last one.
                let (u, i) = (i64::from(column), i64::from(last));
                let twice = u * u - i * i + square(g) - square(self.row[last as usize]);
                let from = twice.div_euclid(2 * (u - i)) + 1;
                if from > i64::from(since) {
                    start = from;
                    break;
                }
                self.vertices.pop();
                self.starts.pop();
            }
            if start < values.len() as i64 {
                self.vertices.push(column);
                self.starts.push(start.max(0) as u32);
            }
        }
        let far = limit * limit;
        let ends = self.starts.iter().skip(1).copied().chain([values.len() as u32]);
        if self.vertices.is_empty() {
            values.fill(far);
        }
        for ((&vertex, &start), end) in self.vertices.iter().zip(&self.starts).zip(ends) {
            let g = self.row[vertex as usize];
            for (x, value) in (start..end).zip(&mut values[start as usize..end as usize]) {
                let dx = x.abs_diff(vertex);
                *value = (dx * dx + g * g).min(far);
            }
        }
    }
}

/// `here = min(here, 1 + beside)`, and no more than the limit.
fn farther(here: &mut [u32], beside: &[u32], limit: u32) {
    for (value, &beside) in here.iter_mut().zip(beside) {
        *value = (*value).min(beside + 1).min(limit);
    }
}
