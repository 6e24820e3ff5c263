use super::Figure;
use crate::source::Finding;

/// Largest picture, in pixels: some decoders need four bytes for each.
const MAX_PIXELS: u64 = 20_000_000;

const HELP: &str = "Save the plot as a PNG or JPEG of at most 2 MB and 20 megapixels.";

/// A PNG or JPEG, told by its bytes and not by its name.
pub(super) fn parse_figure(file_name: &str, bytes: Vec<u8>) -> Result<Figure, Finding> {
    let media_type = match bytes.as_slice() {
        [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n', ..] => "image/png",
        [0xff, 0xd8, 0xff, ..] => "image/jpeg",
        _ => {
            return Err(Finding::error("figure.unreadable", "The file is neither a PNG nor a JPEG picture.")
                .with_help(HELP));
        }
    };
    let size = imagesize::blob_size(&bytes).ok().and_then(|size| {
        let (width, height) = (u32::try_from(size.width).ok()?, u32::try_from(size.height).ok()?);
        (width > 0 && height > 0).then_some((width, height))
    });
    let Some((width, height)) = size else {
        return Err(Finding::error("figure.unreadable", "The picture is damaged: its size cannot be read.")
            .with_help(HELP));
    };
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(Finding::error(
            "figure.too_large",
            format!("The picture has {width} × {height} pixels."),
        )
        .with_help(HELP));
    }
    Ok(Figure { file_name: file_name.to_owned(), media_type, bytes, width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first bytes of a PNG of this size.
    pub fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
        bytes.extend(width.to_be_bytes());
        bytes.extend(height.to_be_bytes());
        bytes.extend([8, 6, 0, 0, 0, 0, 0, 0, 0]);
        bytes
    }

    /// The first bytes of a JPEG of this size.
    fn jpeg(width: u16, height: u16) -> Vec<u8> {
        let mut bytes = b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0\xff\xc0\0\x11\x08".to_vec();
        bytes.extend(height.to_be_bytes());
        bytes.extend(width.to_be_bytes());
        bytes.extend([3, 1, 0x22, 0, 2, 0x11, 1, 3, 0x11, 1]);
        bytes
    }

    #[test]
    fn pictures_are_told_by_their_bytes() {
        for (bytes, expected) in [
            (png(640, 480), Ok(("image/png", 640, 480))),
            (jpeg(640, 480), Ok(("image/jpeg", 640, 480))),
            (png(5_000, 4_000), Ok(("image/png", 5_000, 4_000))),
            (png(5_000, 4_001), Err("figure.too_large")),
            (png(u32::MAX, u32::MAX), Err("figure.too_large")),
            (png(0, 480), Err("figure.unreadable")),
            (b"\x89PNG\r\n\x1a\n".to_vec(), Err("figure.unreadable")),
            (b"\xff\xd8\xff".to_vec(), Err("figure.unreadable")),
            (b"GIF89a\x01\0\x01\0".to_vec(), Err("figure.unreadable")),
            (b"<svg onload=alert(1)>".to_vec(), Err("figure.unreadable")),
            (Vec::new(), Err("figure.unreadable")),
        ] {
            let found = parse_figure("a.png", bytes);
            let found = found.as_ref().map(|f| (f.media_type, f.width, f.height)).map_err(|f| f.code);
            assert_eq!(found, expected);
        }
    }
}
