//! Files that ffmpeg takes for videos and that only name others.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::files::Limit;

/// How far into a file its kind is looked for.
const BEGINNING: u64 = 4096;

const VIDEO: Limit = Limit { what: "a video", most: u64::MAX };

/// How playlists begin, or what stands in their first lines, and what they are called.
const KINDS: [(&str, &str); 8] = [
    ("#extm3u", "an HLS playlist"),
    ("ffconcat version", "a list of ffmpeg's concat"),
    ("<mpd", "a DASH manifest"),
    ("<smoothstreamingmedia", "a Smooth Streaming manifest"),
    ("<compositionplaylist", "an IMF playlist"),
    ("[playlist]", "a playlist"),
    ("v=0\n", "a description of a stream"),
    ("v=0\r\n", "a description of a stream"),
];

/// Refuses a playlist as a video: it names files of any kind anywhere, itself too, and a live one has no end.
///
/// # Errors
/// One sentence with the file and what it is.
pub(super) fn refuse_playlist(file: &Path) -> Result<()> {
    let mut bytes = Vec::new();
    let read = VIDEO.open(file)?.take(BEGINNING).read_to_end(&mut bytes);
    read.with_context(|| format!("cannot read {}", file.display()))?;
    if let Some(what) = playlist(&bytes) {
        bail!(
            "{} is {what}, which names videos and is none: join what it names into one file (ffmpeg -i {0} -c copy joined.mkv)",
            file.display()
        );
    }
    Ok(())
}

/// What a file of that beginning is, if it is a playlist.
fn playlist(beginning: &[u8]) -> Option<&'static str> {
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    let lower = text.to_ascii_lowercase();
    let is_xml = lower.starts_with(b"<");
    let holds = |mark: &str| lower.windows(mark.len()).any(|window| window == mark.as_bytes());
    let is = |mark: &str| lower.starts_with(mark.as_bytes()) || is_xml && mark.starts_with('<') && holds(mark);
    KINDS.iter().find(|(mark, _)| is(mark)).map(|(_, what)| *what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn playlists_are_told_from_videos() {
        let told: [(&[u8], Option<&str>); 8] = [
            (b"#EXTM3U\n#EXT-X-TARGETDURATION:5\n", Some("an HLS playlist")),
            (b"\xef\xbb\xbf \n#extm3u8\n", Some("an HLS playlist")),
            (b"ffconcat version 1.0\nfile a.mp4\n", Some("a list of ffmpeg's concat")),
            (b"<?xml version=\"1.0\"?>\n<!-- -->\n<MPD type=\"dynamic\">", Some("a DASH manifest")),
            (b"v=0\r\no=- 0 0 IN IP4", Some("a description of a stream")),
            (b"", None),
            (b"\0\0\0\x20ftypisom <mpd #EXTM3U", None),
            (b"RIFF", None),
        ];
        for (bytes, what) in told {
            assert_eq!(playlist(bytes), what, "{:?}", String::from_utf8_lossy(bytes));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.mp4");
        std::fs::write(&path, "ffconcat version 1.0\nfile film.mp4\n").unwrap();
        let error = format!("{:#}", refuse_playlist(&path).unwrap_err());
        assert!(error.contains("film.mp4 is a list of ffmpeg's concat, which names videos and is none"), "{error}");
    }
}
