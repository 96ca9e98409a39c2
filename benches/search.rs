//! What a search costs beside the scoring of its poses: the swarm's bookkeeping for 512 particles of 31 degrees of freedom
//! (at most a tenth of an iteration of 0.6 ms is allowed for it), and the filter's.
#![allow(clippy::unwrap_used, reason = "a benchmark ends where something fails")]

mod table;

use pantin::body::Body;
use pantin::search::{Draw, Random, SearchKind, SearchSettings, SearchSpace, Stream};
use table::Table;

fn main() {
    let body = Body::adult(1750.0).unwrap();
    let space = SearchSpace::of(&body).unwrap();
    let centre: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    let spread = space.spread(1.0 / 25.0).unwrap();
    let mut table = Table::new("search", "particle");
    for kind in SearchKind::ALL {
        let settings = SearchSettings { kind, particles: 512, iterations: 1 << 8, ..SearchSettings::default() };
        let mut search = settings.build(&space).unwrap();
        // A fitness that costs next to nothing and lets a few particles improve each time, as a real one does.
        let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
            for (row, fitness) in poses.chunks_exact(31).zip(fitness) {
                *fitness = 1.0 / (1.0 + row[7].abs() + row[12].abs());
            }
            Ok(())
        };
        let (mut left, centre, spread) = (0, &centre, &spread);
        table.row(format!("{}_iteration_512x31", kind.name()), 512, move || {
            if left == 0 {
                search.start_frame(0, centre, spread).unwrap();
                left = search.iterations();
            }
            left -= 1;
            search.iterate(&mut fitness).unwrap();
        });
    }
    type Fill = fn(&Random, Stream, &mut [f32]);
    for (name, fill) in [("uniforms", Random::uniforms as Fill), ("normals", Random::normals as Fill)] {
        let (random, mut rows) = (Random::new(1), vec![0.0; 512 * 31]);
        table.row(format!("{name}_512x31"), 512, move || {
            for (particle, row) in rows.chunks_exact_mut(31).enumerate() {
                let stream = Stream { frame: 0, iteration: 0, particle: particle as u32, draw: Draw::Scatter };
                fill(&random, stream, row);
            }
            std::hint::black_box(&rows);
        });
    }
    table.run();
}
