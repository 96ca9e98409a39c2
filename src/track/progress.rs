//! What a run tells whoever waits for it.

/// What a run tells whoever waits for it; threads that work side by side tell it in turns.
pub trait Progress: Send {
    /// The run begins.
    fn start(&mut self, _run: &RunStart) {}

    /// A frame is done and safe.
    fn frame(&mut self, _frame: &FrameDone) {}

    /// So many steps of so many are done of work that comes before the first frame; `what` says which.
    fn preparing(&mut self, _what: &'static str, _done: usize, _total: usize) {}

    /// The second pass has done the work of so many frames too.
    fn looked_back(&mut self, _done: usize) {}

    /// Something happened that the user should know at once.
    fn tell(&mut self, _news: &str) {}

    /// Whether to stop after the frame in work.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Nobody waits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}

/// How a run begins.
#[derive(Clone, Debug)]
pub struct RunStart {
    /// The first frame.
    pub first_frame: usize,
    /// Frames in all; none where a live source has no end.
    pub frames: Option<usize>,
    /// Frames that an earlier run did already.
    pub done: usize,
    /// Which evaluator, and why.
    pub backend: String,
    /// Where poses can be had as they are found.
    pub outlets: Vec<String>,
    /// Sentences the user should read.
    pub warnings: Vec<String>,
}

/// A frame that was tracked.
#[derive(Clone, Debug)]
pub struct FrameDone {
    /// Its index.
    pub frame: usize,
    /// Frames done, those of an earlier run and those that real time left out included.
    pub done: usize,
    /// The fitness of its pose.
    pub fitness: f32,
    /// Its confidence, in [0, 1].
    pub confidence: f64,
    /// Mean error against the truth so far, mm.
    pub mean_error: Option<f64>,
}
