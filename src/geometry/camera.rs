//! Cameras: where they stand and how their lens maps (METHOD A2).

use glam::{DAffine3, DVec2, DVec3};

use super::{BrownConrady, Tsai, rodrigues_matrix};

/// Largest side of a picture, pixels: places in it are told apart to 1/256 pixel in 32 bits.
pub const LARGEST_SIDE: u32 = 16384;

/// A calibrated camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Its name, as files and columns carry it.
    pub name: String,
    /// Picture size in pixels, width then height.
    pub size: [u32; 2],
    /// Maps a point in the world (mm) to the camera's frame (mm): x right, y down, z along the view.
    pub camera_from_world: DAffine3,
    /// From the camera's frame to pixels.
    pub lens: Lens,
}

/// A lens model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Tsai's model with one radial coefficient.
    Tsai(Tsai),
    /// The model of OpenCV, Pose2Sim, anipose and Qualisys files.
    BrownConrady(BrownConrady),
}

impl Lens {
    /// Normalised undistorted coordinates (x/z, y/z) to normalised distorted ones; None past the end of the branch.
    pub fn distort(&self, undistorted: DVec2) -> Option<DVec2> {
        match self {
            Self::Tsai(lens) => lens.distort(undistorted),
            Self::BrownConrady(lens) => lens.distort(undistorted),
        }
    }

    /// The inverse of [`Self::distort`]; None where no point of the branch has that image.
    pub fn undistort(&self, distorted: DVec2) -> Option<DVec2> {
        match self {
            Self::Tsai(lens) => lens.undistort(distorted),
            Self::BrownConrady(lens) => lens.undistort(distorted),
        }
    }

    /// Normalised distorted coordinates to pixels.
    pub fn to_pixel(&self, distorted: DVec2) -> DVec2 {
        match self {
            Self::Tsai(lens) => lens.to_pixel(distorted),
            Self::BrownConrady(lens) => lens.to_pixel(distorted),
        }
    }

    /// Pixels to normalised distorted coordinates.
    pub fn from_pixel(&self, pixel: DVec2) -> DVec2 {
        match self {
            Self::Tsai(lens) => lens.from_pixel(pixel),
            Self::BrownConrady(lens) => lens.from_pixel(pixel),
        }
    }
}

impl Camera {
    /// A camera whose rotation (camera from world) is a Rodrigues vector in radians, its translation in mm.
    pub fn from_rodrigues(name: &str, size: [u32; 2], lens: Lens, rotation: DVec3, translation: DVec3) -> Self {
        let camera_from_world = DAffine3::from_mat3_translation(rodrigues_matrix(rotation), translation);
        Self { name: name.to_string(), size, camera_from_world, lens }
    }

    /// The camera's centre in the world, mm.
    pub fn centre_in_world(&self) -> DVec3 {
        -(self.camera_from_world.matrix3.transpose() * self.camera_from_world.translation)
    }

    /// A point of the world (mm) to pixels, origin in the centre of the top-left one. None behind the camera and past the
    /// end of the distortion's branch; never NaN. The picture's border plays no part: a pixel may lie outside `size`.
    pub fn project(&self, point_in_world: DVec3) -> Option<DVec2> {
        self.image_of(self.camera_from_world.transform_point3(point_in_world))
    }

    /// Whether a point of the world (mm) lies in the picture.
    pub fn sees(&self, point_in_world: DVec3) -> bool {
        let [width, height] = self.size.map(f64::from);
        let is_inside = |at: DVec2| (-0.5..width - 0.5).contains(&at.x) && (-0.5..height - 0.5).contains(&at.y);
        self.project(point_in_world).is_some_and(is_inside)
    }

    /// [`Self::project`] of a point that is in the camera's own axes (x right, y down, z ahead; mm).
    pub fn image_of(&self, point: DVec3) -> Option<DVec2> {
        if point.z.is_nan() || point.z <= 0.0 {
            return None;
        }
        let pixel = self.lens.to_pixel(self.lens.distort(point.truncate() / point.z)?);
        pixel.is_finite().then_some(pixel)
    }

    /// The ray that a pixel sees, in the world: the camera's centre (mm) and a direction of length 1. None where no point
    /// has that pixel as its image.
    pub fn ray(&self, pixel: DVec2) -> Option<(DVec3, DVec3)> {
        let at = self.lens.undistort(self.lens.from_pixel(pixel))?;
        let direction = (self.camera_from_world.matrix3.transpose() * at.extend(1.0)).normalize();
        let origin = self.centre_in_world();
        (direction.is_finite() && origin.is_finite()).then_some((origin, direction))
    }

    /// The camera of the same pictures resized to `size`. Pixel centres are whole numbers, so a coordinate c becomes
    /// (c + 0.5) s - 0.5, separately for x and y. Both sizes must be more than 0.
    pub fn scaled(&self, size: [u32; 2]) -> Self {
        let [s_x, s_y] = [0, 1].map(|axis| f64::from(size[axis]) / f64::from(self.size[axis]));
        let s = DVec2::new(s_x, s_y);
        let moved = |centre: DVec2| (centre + 0.5) * s - 0.5;
        let lens = match self.lens {
            Lens::Tsai(lens) => Lens::Tsai(Tsai { centre: moved(lens.centre), pitch: lens.pitch / s, ..lens }),
            Lens::BrownConrady(lens) => {
                Lens::BrownConrady(BrownConrady { centre: moved(lens.centre), focal: lens.focal * s, ..lens })
            }
        };
        Self { name: self.name.clone(), size, camera_from_world: self.camera_from_world, lens }
    }
}

#[cfg(test)]
#[path = "camera_tests.rs"]
mod tests;
