//! What people look at: overlays, plots, the HTML page, and the same as a recording.

mod arrows;
mod comparison;
mod html;
mod live_page;
mod overlay;
mod plot;
mod recording;
mod timeline;

pub use arrows::{Arrow, arrow_chart};
pub use comparison::{Shares, XyLine, share_chart, xy_chart};
pub use html::{
    CameraFrame, Headline, JointError, OverlayFrame, Player, ReportData, Skeleton, StageTime, jpeg, page, write_page,
};
pub use live_page::{LivePage, live_page};
pub use overlay::{Canvas, OverlayPolygon, part_colour, side_by_side};
pub use plot::{Series, bar_chart, line_chart};
pub use recording::{RecordedView, check_recordings_are_built, write_recording};
pub use timeline::{Bar, Mark, TimelineChart, timeline_chart};
