//! Jumping on the spot, again and again: down into the knees, up off the floor, and down into the knees to land.

use anyhow::Result;
use glam::{DVec2, DVec3};

use super::{set, soft_minimum, sole_points};
use crate::body::{Body, DofAxis};

/// mm/s^2
const GRAVITY: f64 = 9810.0;

/// A person who jumps.
#[derive(Clone, Debug)]
pub struct Jump {
    body: Body,
    at: DVec2,
    /// radians
    heading: f64,
    /// Seconds from one jump to the next.
    period: f64,
    /// Seconds in the air.
    flight: f64,
    /// mm
    height: f64,
}

impl Jump {
    /// `body` jumping `height` mm high every `period` seconds at a place on the floor, facing `heading` (radians).
    pub fn new(body: &Body, at: DVec2, heading: f64, height: f64, period: f64) -> Self {
        let flight = (8.0 * height / GRAVITY).sqrt().min(0.6 * period);
        Self { body: body.clone(), at, heading, period, flight, height }
    }

    /// The state vector (mm, radians) at a time in seconds.
    ///
    /// # Errors
    /// When the body cannot be posed.
    pub fn pose(&self, time: f64) -> Result<Vec<f64>> {
        let time = time.rem_euclid(self.period);
        let rest = self.period - self.flight;
        // On the floor: half of the time to wind up, a third to land, the rest to stand.
        let (wind_up, landing) = (0.5 * rest, 0.33 * rest);
        let land = wind_up + self.flight;
        let bell = |t: f64| (std::f64::consts::PI * t.clamp(0.0, 1.0)).sin().powi(2);
        let (crouch, arms);
        let mut up = 0.0;
        if time < wind_up {
            let t = time / wind_up;
            // Slowly down, quickly up.
            crouch = bell(t * t);
            arms = if t < 0.7 { -0.35 * bell(t / 0.7) } else { smooth((t - 0.7) / 0.3) };
        } else if time < land {
            let t = (time - wind_up) / self.flight;
            up = 4.0 * t * (1.0 - t) * self.height;
            arms = 1.0 - 0.4 * smooth(t);
            crouch = 0.12 * bell(t);
        } else {
            let t = (time - land) / landing;
            crouch = 0.8 * bell(t.min(1.0).sqrt());
            arms = 0.6 * (1.0 - smooth(t));
        }
        let mut pose = vec![0.0; self.body.dof_count()];
        let mut degrees = |bone: &str, axis, value: f64| set(&self.body, &mut pose, bone, axis, value.to_radians());
        degrees("pelvis", DofAxis::Ry, 18.0 * crouch);
        degrees("thorax", DofAxis::Ry, 3.0 + 24.0 * crouch);
        degrees("head", DofAxis::Ry, -20.0 * crouch);
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            // Shins stay nearly upright: the feet are fixed to them.
            degrees(&format!("{side}_hip"), DofAxis::Ry, -(78.0 + 18.0) * crouch);
            degrees(&format!("{side}_hip"), DofAxis::Rx, sign * 4.0);
            degrees(&format!("{side}_knee"), DofAxis::Ry, 80.0 * crouch);
            degrees(&format!("{side}_shoulder"), DofAxis::Rx, sign * 10.0);
            degrees(&format!("{side}_shoulder"), DofAxis::Ry, -150.0 * arms);
            degrees(&format!("{side}_elbow"), DofAxis::Ry, -18.0);
        }
        set(&self.body, &mut pose, "pelvis", DofAxis::Rz, self.heading);
        // The middle of the feet stays where it is.
        let soles = sole_points(&self.body, &pose)?;
        let middle = soles.iter().sum::<DVec3>() / soles.len().max(1) as f64;
        let place = (self.at - middle.truncate()).extend(up - soft_minimum(&soles));
        for (axis, value) in [DofAxis::Tx, DofAxis::Ty, DofAxis::Tz].into_iter().zip(place.to_array()) {
            set(&self.body, &mut pose, "pelvis", axis, value);
        }
        Ok(pose)
    }
}

fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_leave_the_floor_and_come_back_to_their_place() {
        let body = Body::adult(1750.0).unwrap();
        let jump = Jump::new(&body, DVec2::new(200.0, 100.0), 0.7, 350.0, 1.8);
        let (mut highest, mut before) = (0.0f64, None::<Vec<f64>>);
        for step in 0..360 {
            let pose = jump.pose(f64::from(step) * 0.01).unwrap();
            body.check_limits(&pose).unwrap();
            let soles = sole_points(&body, &pose).unwrap();
            let lowest = soles.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            assert!(lowest > -1.0, "{lowest}");
            highest = highest.max(lowest);
            let middle = soles.iter().sum::<DVec3>() / soles.len() as f64;
            assert!((middle.truncate() - DVec2::new(200.0, 100.0)).length() < 1e-6);
            if let Some(before) = before {
                let most = pose[6..].iter().zip(&before[6..]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(most < 0.35, "a joint turns by {most} in a hundredth of a second");
            }
            before = Some(pose);
        }
        assert!((330.0..370.0).contains(&highest), "{highest}");
    }
}
