//! The camera's sensor: encoding of light, photon and read-out noise, rounding to bytes.

use super::hash::hash;

/// Turns linear light into noisy bytes.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Standard deviation of the noise at full brightness, grey levels of 255.
    noise: f64,
    /// Factor on the light.
    gain: f32,
    is_grey: bool,
    seed: u64,
    /// Encoded level (0..=255) of linear light in steps of 1 / (length - 1).
    encoding: Vec<f32>,
}

const ENCODING_STEPS: usize = 4096;

impl Sensor {
    /// A colour sensor of gain 1 with noise of `noise` grey levels (standard deviation in bright places; dark ones get a little less).
    pub fn new(noise: f64, seed: u64) -> Self {
        let encoding = (0..=ENCODING_STEPS)
            .map(|i| {
                // The transfer curve of sRGB.
                let linear = i as f64 / ENCODING_STEPS as f64;
                let level = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
                (255.0 * level) as f32
            })
            .collect();
        Self { noise, gain: 1.0, is_grey: false, seed, encoding }
    }

    /// The same sensor with another gain: what it lifts above 1 is white.
    pub fn with_gain(self, gain: f64) -> Self {
        Self { gain: gain as f32, ..self }
    }

    /// The same sensor, grey or not.
    pub fn grey(self, is_grey: bool) -> Self {
        Self { is_grey, ..self }
    }

    /// Bytes a pixel: 1 or 3.
    pub fn channels(&self) -> usize {
        if self.is_grey { 1 } else { 3 }
    }

    /// The bytes of a picture of linear light, without noise: one (grey) or three (RGB) a pixel.
    pub fn expose_clean(&self, light: &[[f32; 3]]) -> Vec<u8> {
        self.levels(light).map(|level| (level + 0.5) as u8).collect()
    }

    /// The bytes of a picture as the camera number `camera` takes it in frame `frame`.
    pub fn expose(&self, light: &[[f32; 3]], camera: usize, frame: usize) -> Vec<u8> {
        let picture = u64::from(hash(self.seed ^ ((camera as u64) << 48) ^ frame as u64)) << 32;
        let noisy = |(sample, level): (usize, f32)| {
            // Half of the variance is read-out noise, half grows with the light.
            let deviation = self.noise as f32 * (0.5 + 0.5 * level / 255.0).sqrt();
            let normal = nearly_normal(hash(picture | sample as u64));
            (level + deviation * normal + 0.5).clamp(0.0, 255.0) as u8
        };
        self.levels(light).enumerate().map(noisy).collect()
    }

    /// Encoded levels, 0 to 255, channel by channel.
    fn levels<'a>(&'a self, light: &'a [[f32; 3]]) -> impl Iterator<Item = f32> + 'a {
        light.iter().flat_map(move |rgb| {
            let [red, green, blue] = rgb.map(|value| value * self.gain);
            // Luminance of linear light in sRGB's primaries.
            let grey = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
            let samples = if self.is_grey { [grey; 3] } else { [red, green, blue] };
            samples.into_iter().take(self.channels()).map(|value| self.encode(value))
        })
    }

    fn encode(&self, linear: f32) -> f32 {
        // NaN casts to 0.
        let position = linear.clamp(0.0, 1.0) * ENCODING_STEPS as f32;
        let index = (position as usize).min(ENCODING_STEPS - 1);
        let (low, high) = (self.encoding[index], self.encoding[index + 1]);
        low + (high - low) * (position - index as f32)
    }
}

/// Mean 0, deviation 1, bell-shaped within +-3.4: the sum of the four bytes of a random number.
fn nearly_normal(random: u32) -> f32 {
    let sum: u32 = random.to_le_bytes().map(u32::from).iter().sum();
    // Each byte has mean 127.5 and variance (256^2 - 1) / 12.
    (sum as f32 - 510.0) / 147.8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_stated_size_and_repeats() {
        let light = vec![[0.215_860_5_f32; 3]; 40_000];
        let sensor = Sensor::new(4.0, 7);
        let clean = sensor.expose_clean(&light);
        let noisy = sensor.expose(&light, 1, 2);
        let difference: Vec<f64> = noisy.iter().zip(&clean).map(|(&a, &b)| f64::from(a) - f64::from(b)).collect();
        let mean = difference.iter().sum::<f64>() / difference.len() as f64;
        let deviation = (difference.iter().map(|d| d * d).sum::<f64>() / difference.len() as f64).sqrt();
        let expected = 4.0 * (0.5 + 0.5 * f64::from(clean[0]) / 255.0).sqrt();
        assert!(mean.abs() < 0.1, "{mean}");
        assert!((deviation - expected).abs() < 0.15, "{deviation} {expected}");
        assert_eq!(noisy, sensor.expose(&light, 1, 2));
        assert_ne!(noisy, sensor.expose(&light, 1, 3), "another frame");
        assert_ne!(noisy, sensor.expose(&light, 2, 2), "another camera");
        assert_ne!(noisy, Sensor::new(4.0, 8).expose(&light, 1, 2), "another seed");
    }

    #[test]
    fn grey_and_saturated() {
        let light = [[0.2, 0.2, 0.2], [0.6, 0.1, 0.0], [0.0, 1.0, 0.0]];
        let (colour, grey) = (Sensor::new(0.0, 0), Sensor::new(0.0, 0).grey(true));
        let (rgb, levels) = (colour.expose_clean(&light), grey.expose_clean(&light));
        assert_eq!((rgb.len(), levels.len()), (9, 3));
        assert_eq!(levels[0], rgb[0]);
        assert!(levels[1] < levels[2], "green is brighter than red");
        let bright = Sensor::new(0.0, 0).with_gain(2.0).expose_clean(&light);
        assert_eq!(bright[3], 255, "0.6 at twice the gain is white");
        assert!(bright[0] > rgb[0] && bright[0] < 255);
    }

    #[test]
    fn the_encoding_is_srgb() {
        let bytes = Sensor::new(0.0, 0).expose_clean(&[[0.0, 0.215_860_5, 1.0], [f32::NAN, -1.0, 9.0]]);
        assert_eq!(bytes, [0, 128, 255, 0, 0, 255]);
    }
}
