//! The names that a scene chooses by.

use crate::files::choices;

choices! {
    /// The built-in scenes: the demo, five after the sequences that the method was first measured on (METHOD A10), and two with two
    /// people at once.
    "scene" pub enum ScenePreset => pub(super) text: &'static str {
        /// What `pantin demo` tracks.
        "demo" Demo => include_str!("../presets/demo.toml"),
        /// Four grey cameras, 640x480, 60 Hz, a walk in a circle, 15 markers.
        "leewalk" Leewalk => include_str!("../presets/leewalk.toml"),
        /// Four colour cameras, 480x270, 25 Hz, one person going straight, 39 markers.
        "p1s" OneStraight => include_str!("../presets/p1s.toml"),
        /// The same with another person: smaller, stouter, in other clothes, with quicker and shorter steps.
        "p2s" OtherStraight => include_str!("../presets/p2s.toml"),
        /// The first person going diagonally.
        "p1d" OneDiagonal => include_str!("../presets/p1d.toml"),
        /// The other person going diagonally.
        "p2d" OtherDiagonal => include_str!("../presets/p2d.toml"),
        /// Two people at once, going straight past each other.
        "two_straight" TwoStraight => include_str!("../presets/two_straight.toml"),
        /// Two people at once, going diagonally, whose ways cross before the cameras.
        "two_diagonal" TwoDiagonal => include_str!("../presets/two_diagonal.toml"),
    }
}

choices! {
    /// How somebody moves without a motion file.
    #[derive(Default)]
    "gait" pub enum Gait {
        /// Walks in a circle.
        "circle" #[default] Circle,
        /// Walks along a line.
        "straight" Straight,
        /// Walks along the room's diagonal.
        "diagonal" Diagonal,
        /// Runs along a line.
        "run" Run,
        /// Jumps on the spot.
        "jump" Jump,
        /// Stands at ease.
        "stand" Stand,
        /// Stands with the arms out sideways, swaying a little.
        "t-pose" TPose,
    }
}

choices! {
    /// How cameras stand.
    #[derive(Default)]
    "rig" pub enum RigKind {
        /// Four in the corners.
        "corners" #[default] Corners,
        /// Any number round the room.
        "ring" Ring,
    }
}

choices! {
    /// The lenses of a rig.
    #[derive(Default)]
    "rig lens" pub enum LensKind {
        /// OpenCV's, with distortion.
        "brown-conrady" #[default] BrownConrady,
        /// Tsai's, with to first order the same distortion.
        "tsai" Tsai,
        /// Without distortion.
        "pinhole" Pinhole,
    }
}

choices! {
    /// How a sequence's pictures are kept, and where those of a camera are.
    #[derive(Default)]
    "form of pictures" pub enum PictureForm => pub(crate) place: [&'static str; 3] {
        /// A PNG file a frame.
        "png" #[default] Png => ["frames", "_%04d", "png"],
        /// A JPEG file a frame.
        "jpeg" Jpeg => ["frames", "_%04d", "jpg"],
        /// A video (H.264 through ffmpeg).
        "video" Video => ["videos", "", "mp4"],
    }
}

choices! {
    /// The unit of a motion file.
    "motion unit" pub enum MotionUnit => pub(crate) mm: f64 {
        /// Millimetres.
        "mm" Millimetre => 1.0,
        /// Centimetres.
        "cm" Centimetre => 10.0,
        /// Inches.
        "inch" Inch => 25.4,
        /// Metres.
        "m" Metre => 1000.0,
    }
}

choices! {
    /// What of a person's looks a scene may replace.
    "part of clothes" pub enum Garment {
        /// Skin, face and hands.
        "skin" Skin,
        /// Hair.
        "hair" Hair,
        /// Shirt.
        "shirt" Shirt,
        /// Trousers.
        "trousers" Trousers,
        /// Shoes.
        "shoes" Shoes,
    }
}
