use super::*;
use crate::texture::noise::mixed;
use image::Rgb;

fn example(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let word = mixed(u64::from(y * 1000 + x));
        Rgb([word as u8, (word >> 8) as u8, (word >> 16) as u8])
    })
}

#[test]
fn both_ways_measure_what_the_definition_says() {
    for (width, height) in [(37, 22), (64, 64), (5, 40)] {
        let matcher = Matcher::new(&example(width, height), None);
        let size = [5, 7];
        let known: Vec<Known> = (0..20)
            .map(|i| {
                let word = mixed(900 + i);
                let colour = weighted([word as u8, (word >> 8) as u8, (word >> 16) as u8].map(f32::from));
                let weight = 1.0 - 0.04 * i as f32;
                Known { x: i as usize % 5, y: i as usize / 5 + i as usize % 2, colour, weight }
            })
            .filter(|pixel| (pixel.x, pixel.y) != (0, 0))
            .collect();
        let mut once = std::collections::HashSet::new();
        let known: Vec<Known> = known.into_iter().filter(|pixel| once.insert((pixel.x, pixel.y))).collect();
        let (direct, fourier) = (matcher.errors(size, &known, Way::Direct), matcher.errors(size, &known, Way::Fourier));
        let columns = width as usize - 4;
        assert_eq!(direct.len(), columns * (height as usize - 6));
        for (i, (direct, fourier)) in direct.iter().zip(&fourier).enumerate() {
            let (x, y) = (i % columns, i / columns);
            let sum: f64 = known
                .iter()
                .map(|pixel| {
                    let error = squared_error(matcher.colour(x + pixel.x, y + pixel.y), pixel.colour);
                    f64::from(pixel.weight) * f64::from(error)
                })
                .sum();
            assert!((f64::from(*direct) - sum).abs() < 1e-4, "{direct} {sum}");
            assert!((f64::from(*fourier) - sum).abs() < 1e-3, "{fourier} {sum}");
        }
    }
}

#[test]
fn the_choice_does_not_depend_on_the_way() {
    // Regions of pieces that are nowhere in the example, many of them nearly as good as the best.
    let picture = RgbImage::from_fn(64, 64, |x, y| {
        let word = mixed(u64::from(y * 1000 + x)) % 3;
        Rgb([(100 + x % 8 * 10 + word) as u8, (90 + y % 8 * 9 + word) as u8, 60])
    });
    let matcher = Matcher::new(&picture, None);
    for piece in 0..30_u64 {
        let known: Vec<Known> = (0..400)
            .map(|i| {
                let colour = [(100 + (i % 20 + 3 * piece) % 80) as f32, (90 + (i / 20 * 7) % 60) as f32, 61.0];
                Known { x: i as usize % 20, y: i as usize / 20, colour: weighted(colour), weight: 1.0 }
            })
            .collect();
        assert_eq!(matcher.cheaper(45 * 45, 400), Way::Fourier);
        let (place, error) = matcher.best([20, 20], &known).unwrap().unwrap();
        let direct = matcher.errors([20, 20], &known, Way::Direct);
        let least = direct.iter().copied().fold(f32::INFINITY, f32::min);
        let first = direct.iter().position(|error| *error == least).unwrap();
        assert_eq!((place, error.to_bits()), ([first % 45, first / 45], least.to_bits()));
    }
}

/// However many threads share a search, whatever limits it: the first of the least.
#[test]
fn giving_up_early_changes_no_choice() {
    // Few colours, so that many placements are equal; wide enough for several tasks.
    let picture = RgbImage::from_fn(230, 190, |x, y| Rgb([(mixed(u64::from(y / 2 * 300 + x / 2)) % 3 * 60) as u8; 3]));
    let usable: Vec<bool> = (0..230 * 190).map(|i| !mixed(i).is_multiple_of(400)).collect();
    for (case, mask) in (0..24_u64).zip([None, Some(usable.as_slice())].into_iter().cycle()) {
        let matcher = Matcher::new(&picture, mask);
        let known: Vec<Known> = (0..49)
            .filter(|i| !mixed(case * 64 + i).is_multiple_of(3))
            .map(|i| {
                let colour = weighted([(mixed(case * 999 + i / 4) % 3 * 60) as f32; 3]);
                let weight = if case % 4 < 2 { 1.0 } else { 1.0 / (1.0 + i as f32) };
                Known { x: i as usize % 7, y: i as usize / 7, colour, weight }
            })
            .collect();
        let errors = matcher.errors([7, 7], &known, Way::Direct);
        let places = (0..errors.len()).filter(|i| matcher.is_usable(i % 224, i / 224, [7, 7]));
        let first = places.reduce(|best, i| if errors[i] < errors[best] { i } else { best }).unwrap();
        let least = errors[first];
        for (limit, is_below) in [(f32::INFINITY, true), (least * 1.5, true), (least.next_up(), true), (least, false)] {
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let found = pool.install(|| matcher.best_below([7, 7], &known, limit).unwrap());
                assert_eq!(found, is_below.then_some(([first % 224, first / 224], least)), "{case} {limit}");
            }
        }
        let [x, y] = [first % 224, first / 224];
        assert_eq!(matcher.error_within([7, 7], [x, y], &known, least).to_bits(), least.to_bits());
        assert_eq!(matcher.error_within([7, 7], [224, y], &known, f32::INFINITY), f32::INFINITY);
    }
}

#[test]
fn a_piece_of_the_example_is_found_where_it_is_unless_forbidden() {
    let picture = example(40, 30);
    let matcher = Matcher::new(&picture, None);
    let known: Vec<Known> = (0..64)
        .map(|i| Known { x: i % 8, y: i / 8, colour: matcher.colour(11 + i % 8, 9 + i / 8), weight: 1.0 })
        .collect();
    let (place, error) = matcher.best([8, 8], &known).unwrap().unwrap();
    assert_eq!(place, [11, 9]);
    assert!(error < 1e-3);
    let usable: Vec<bool> = (0..1200).map(|i| i != 12 * 40 + 13).collect();
    let matcher = Matcher::new(&picture, Some(&usable));
    let ([x, y], _) = matcher.best([8, 8], &known).unwrap().unwrap();
    assert!(!(x..x + 8).contains(&13) || !(y..y + 8).contains(&12), "{x} {y} covers the forbidden pixel");
    assert_eq!(matcher.best([41, 1], &known).unwrap(), None);
    let none = Matcher::new(&picture, Some(&[false; 1200]));
    assert_eq!(none.first_usable([1, 1], 0..1200), None);
}
