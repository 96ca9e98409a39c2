//! The options a manifest may hand to ffmpeg for a live source. A manifest comes from anyone: an option that is not known
//! here could make ffmpeg write files or open something else.

use anyhow::{Result, bail};

use crate::files::nearest;

/// Options with one value.
const WITH_VALUE: [&str; 28] = [
    "f",
    "r",
    "framerate",
    "video_size",
    "s",
    "pixel_format",
    "pix_fmt",
    "input_format",
    "standard",
    "channel",
    "c:v",
    "codec:v",
    "vcodec",
    "rtsp_transport",
    "timeout",
    "stimeout",
    "rw_timeout",
    "probesize",
    "analyzeduration",
    "fflags",
    "flags",
    "thread_queue_size",
    "reorder_queue_size",
    "max_delay",
    "buffer_size",
    "stream_loop",
    "hwaccel",
    "user_agent",
];
/// Options without.
const ALONE: [&str; 1] = ["re"];

/// Holds options to those known.
///
/// # Errors
/// With the option, and the nearest known one.
pub(super) fn check(options: &[String]) -> Result<()> {
    let mut options = options.iter();
    while let Some(option) = options.next() {
        let Some(name) = option.strip_prefix('-') else {
            bail!("`input` has {option:?} where an option is expected, like \"-f\", \"v4l2\"");
        };
        if ALONE.contains(&name) {
            continue;
        }
        if !WITH_VALUE.contains(&name) {
            let known = WITH_VALUE.iter().chain(&ALONE);
            let nearest = nearest(name, known.copied()).unwrap_or_default();
            bail!("`input` has {option:?}, which is none of the options taken here; the nearest is \"-{nearest}\"");
        }
        if options.next().is_none() {
            bail!("`input` ends after {option:?}, expected its value");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_options_pass() {
        let check = |options: &[&str]| check(&options.iter().map(|text| (*text).to_string()).collect::<Vec<_>>());
        check(&["-re", "-f", "lavfi", "-framerate", "30"]).unwrap();
        check(&[]).unwrap();
        for (options, part) in [
            (&["-f"][..], "ends after \"-f\""),
            (&["-re", "out.mp4"], "\"out.mp4\" where an option is expected"),
            (&["-frame_rate", "3"], "nearest is \"-framerate\""),
            (&["-i", "/etc/passwd"], "none of the options"),
            (&["-y"], "none of the options"),
            (&[""], "where an option is expected"),
        ] {
            let error = check(options).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
