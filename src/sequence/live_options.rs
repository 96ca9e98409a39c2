//! What a manifest may hand to ffmpeg for a live source. A manifest comes from anyone: an option, a format or a graph of filters that is
//! not known here could make ffmpeg write files or open something else.

use anyhow::{Result, bail, ensure};

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

/// Formats: cameras, what streams and pipes carry, and pictures made up (see [`GENERATORS`]).
const FORMATS: [&str; 22] = [
    "v4l2",
    "video4linux2",
    "avfoundation",
    "dshow",
    "android_camera",
    "mpegts",
    "mjpeg",
    "mpjpeg",
    "rtsp",
    "rtp",
    "flv",
    "h264",
    "hevc",
    "av1",
    "ivf",
    "nut",
    "matroska",
    "webm",
    "rawvideo",
    "image2pipe",
    "yuv4mpegpipe",
    "lavfi",
];
/// Filters that make pictures up and do nothing else: all that `-f lavfi` may run, one of them by itself.
const GENERATORS: [&str; 7] = ["testsrc", "testsrc2", "smptebars", "smptehdbars", "color", "mandelbrot", "rgbtestsrc"];

/// Protocols that ffmpeg may open: what cameras speak, files and pipes. None of them writes or joins other addresses.
pub(super) const PROTOCOLS: &str = "file,pipe,fd,http,https,httpproxy,tcp,tls,udp,udplite,rtp,srtp,srt,rtmp,rtmps";

/// Holds a source and its options to what is known.
///
/// # Errors
/// With the option or the format and the nearest known one, or with the graph.
pub(super) fn check(source: &str, options: &[String]) -> Result<()> {
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
        let Some(value) = options.next() else {
            bail!("`input` ends after {option:?}, expected its value");
        };
        if name == "f" && !FORMATS.contains(&value.as_str()) {
            let nearest = nearest(value, FORMATS).unwrap_or_default();
            bail!("`input` has the format {value:?}, which is none of those taken here; the nearest is {nearest:?}");
        }
        if (name, value.as_str()) == ("f", "lavfi") {
            let (filter, settings) = source.split_once('=').unwrap_or((source, ""));
            let is_plain = settings.chars().all(|c| c.is_ascii_alphanumeric() || "=:.#_/ -".contains(c));
            ensure!(
                GENERATORS.contains(&filter) && is_plain,
                "`source` is {source:?} for the format \"lavfi\", expected one of {} and its settings, nothing after it",
                GENERATORS.join(", ")
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_options_pass() {
        let check = |options: &[&str]| check("x", &options.iter().map(|text| (*text).to_string()).collect::<Vec<_>>());
        check(&["-re", "-f", "v4l2", "-framerate", "30"]).unwrap();
        check(&[]).unwrap();
        for (options, part) in [
            (&["-f"][..], "ends after \"-f\""),
            (&["-re", "out.mp4"], "\"out.mp4\" where an option is expected"),
            (&["-frame_rate", "3"], "nearest is \"-framerate\""),
            (&["-i", "/etc/passwd"], "none of the options"),
            (&["-y"], "none of the options"),
            (&[""], "where an option is expected"),
            (&["-f", "concat"], "the format \"concat\""),
            (&["-f", "mpegt"], "nearest is \"mpegts\""),
        ] {
            let error = check(options).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn graphs_that_could_do_more_than_make_pictures_are_refused() {
        let check = |source: &str| check(source, &["-f".to_string(), "lavfi".to_string()]);
        for source in ["testsrc2", "testsrc2=size=64x48:rate=25:duration=1", "color=c=#203040:s=64x48"] {
            check(source).unwrap();
        }
        for source in [
            "testsrc=size=64x48,metadata=mode=print:file=out.txt",
            "testsrc2=size=64x48[out0];movie=a.mp4[out1]",
            "movie=a.mp4",
            "testsrc2='a,b'",
            "life=filename=/etc/passwd",
            "",
        ] {
            let error = check(source).unwrap_err().to_string();
            assert!(error.contains("nothing after it"), "{error}");
        }
    }
}
