//! `pantin texture`: procedural materials, and textures from an example.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::builder::NonEmptyStringValueParser;
use image::codecs::png::PngEncoder;
use image::{DynamicImage, GrayImage, RgbImage};

use super::belonging::{refuse_with, refuse_without};
use super::draws::Draws;
use super::output::{put, say};
use super::progress::ProgressBar;
use crate::files::{Choice as _, Limit, Overwrite, PICTURE_FORMATS, choices, png_name, read_toml, write_atomically};
use crate::synth::portrait;
use crate::texture::example::{Example, Settings, patch_count, synthesise};
use crate::texture::materials::{Material, MaterialKind, Parameters};
use crate::texture::noise::NoiseWay;
use crate::texture::painter::Painter;
use crate::texture::palette::palette;
use crate::texture::picture::{View, check_size};
use crate::texture::relief::relief;
use crate::texture::sheet::contact_sheet;
use crate::texture::solids::{Solid, lit};

/// Draw a procedural material, or synthesise a texture from an example.
///
/// `pantin texture marble -o marble.png`, `pantin texture terrain --preview surface -o land.png`, `pantin texture --list -o sheet.png`, or
/// `pantin texture --example brick.png -o wall.png`.
#[derive(clap::Args, Debug)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["material", "list", "example"])))]
pub(super) struct TextureArgs {
    /// The material's name: see --list
    material: Option<String>,
    /// List the materials, one line each; with -o also draw a sheet of all of them
    #[arg(long)]
    list: bool,
    /// A picture to synthesise a texture from; given several times, the best place in any of them is taken
    #[arg(long, value_name = "PICTURE")]
    example: Vec<PathBuf>,
    /// The PNG to write
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    size: [u32; 2],
    /// Lower left corner of the part of the material, units (X,Y or X,Y,Z)
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,0", value_parser = parse_offset, allow_hyphen_values = true)]
    offset: [f32; 3],
    /// Units of the material across the picture (of a preview: units a unit of the object, 1 without it)
    #[arg(long, value_name = "UNITS")]
    scale: Option<f32>,
    /// Another seed gives another piece of the same material
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Make the picture continue over its borders into itself
    #[arg(long)]
    tile: bool,
    /// Bits a channel
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = ["8", "16"])]
    depth: String,
    /// Write heights (grey) instead of colours
    #[arg(long, conflicts_with = "preview")]
    height_map: bool,
    /// Print the material's parameters with their defaults, as --params reads them, and draw nothing
    #[arg(long, requires = "material", conflicts_with_all = ["params", "output"])]
    defaults: bool,
    /// Parameters of the material, instead of its defaults (see --defaults)
    #[arg(long, value_name = "FILE.toml")]
    params: Option<PathBuf>,
    /// Show the material on an object under a light
    #[arg(long, conflicts_with = "tile")]
    preview: Option<Preview>,
    /// With --preview person: a skinned glTF person instead of one of ellipsoids and capsules
    #[arg(long, value_name = "FILE.glb", requires = "preview")]
    person: Option<PathBuf>,
    /// From an example: side of a patch, pixels, or its width and height: powers of two
    #[arg(long, value_name = "SIDE|WxH", default_value = "32", value_parser = parse_patch)]
    patch: [u32; 2],
    /// From an example: pixels by which patches overlap
    #[arg(long, value_name = "PIXELS", default_value_t = Settings::default().overlap)]
    overlap: u32,
    /// From an example: error of a patch, 0 to 1, above which it is split: 0 works pixel by pixel, 1 never splits
    #[arg(long, value_name = "ERROR", default_value_t = Settings::default().delta_max)]
    delta_max: f32,
    /// From an example: error of a pixel of an overlap, 0 to 1, above which it is synthesised anew
    #[arg(long, value_name = "ERROR", default_value_t = Settings::default().delta_pixel)]
    delta_pixel: f32,
    /// From an example: a picture of its size, dark where it may not be used. Masks go with the examples in their order: ALL uses one
    /// whole, as one without a mask is, IGNORE not at all
    #[arg(long, value_name = "PICTURE|ALL|IGNORE", requires = "example", alias = "sample-masks")]
    #[arg(value_parser = NonEmptyStringValueParser::new())]
    mask: Vec<String>,
    /// Fill in the first example: a picture of its size, dark where it is to be synthesised, bright where it stays as it is
    #[arg(long, value_name = "PICTURE", requires = "example", conflicts_with_all = ["size", "inpaint_channel"])]
    inpaint: Option<PathBuf>,
    /// Fill in the first example where this channel of it is dark, or transparent: a
    #[arg(long, value_name = "CHANNEL", requires = "example", conflicts_with = "size")]
    inpaint_channel: Option<Channel>,
    /// From an example: also write a picture of the patches
    #[arg(long, value_name = "FILE", requires = "example")]
    decomposition: Option<PathBuf>,
    /// From an example: also write a picture of the pixels that were synthesised anew
    #[arg(long, value_name = "FILE", requires = "example")]
    resynthesised: Option<PathBuf>,
    /// What draws a material, or measures how well patches of an example fit; the picture is the same
    #[arg(long, default_value_t)]
    backend: Draws,
    /// How a material's noise comes about: by arithmetic, from tables, or from a precomputed volume; each has other pieces of the material
    #[arg(long, value_name = "WAY", default_value_t)]
    noise: NoiseWay,
    /// Colours of a terrain taken from a picture: its darkest are the lowest
    #[arg(long, value_name = "PICTURE", requires = "material")]
    palette: Option<PathBuf>,
    /// Replace files that are there
    #[arg(long)]
    force: bool,
}

choices! {
    /// An object under a light.
    "preview" enum Preview => object: Object {
        /// A ball.
        "sphere" Sphere => Object::Solid(Solid::Sphere),
        /// A cube, seen from above a corner.
        "cube" Cube => Object::Solid(Solid::Cube),
        /// A square leaning back.
        "plane" Plane => Object::Solid(Solid::Plane),
        /// A standing person in clothes of the material.
        "person" Person => Object::Person,
        /// The surface that its heights make: a block of land with shadows.
        "surface" Surface => Object::Surface,
    }
}

/// What a material is shown on.
#[derive(Clone, Copy)]
enum Object {
    Solid(Solid),
    Person,
    Surface,
}

choices! {
    /// A channel of a picture.
    "channel" enum Channel => index: usize {
        /// Red.
        "r" Red => 0,
        /// Green.
        "g" Green => 1,
        /// Blue.
        "b" Blue => 2,
        /// Opacity.
        "a" Alpha => 3,
    }
}

fn parse_patch(text: &str) -> Result<[u32; 2], String> {
    if let Ok(side) = text.parse() {
        return Ok([side, side]);
    }
    parse_size(text).map_err(|_| "expected a side in pixels, 32 say, or a width and a height, 32x16 say".into())
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.parse::<u32>().ok();
    text.split_once('x')
        .and_then(|(width, height)| Some([number(width)?, number(height)?]))
        .ok_or_else(|| "expected a width and a height in pixels, 640x480 say".into())
}

fn parse_offset(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y]) => Ok([x, y, 0.0]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err("expected two or three numbers, 1.5,-2 say".into()),
    }
}

/// Runs the command.
///
/// # Errors
/// When the material or a parameter is unknown, a size makes no sense, or a file cannot be read or written.
pub(super) fn run(args: &TextureArgs) -> Result<()> {
    if let Some(name) = args.material.as_ref().filter(|_| args.defaults) {
        put!("{}", MaterialKind::of(name)?.defaults()?);
        return Ok(());
    }
    match (args.example.first(), &args.material, &args.output) {
        (None, None, output) => list(args, output.as_deref()),
        (_, _, None) => bail!("the PNG to write is not given, expected -o FILE"),
        (example, material, Some(output)) => {
            let Drawn { picture, resynthesised } = drawn(args)?;
            let (width, height, output) = (picture.width(), picture.height(), output.display());
            match (example, material) {
                (None, Some(name)) => say!("wrote {name}, {width} x {height} pixels, to {output}"),
                _ => say!("wrote {width} x {height} pixels, of them {resynthesised} synthesised anew, to {output}"),
            }
            Ok(())
        }
    }
}

/// What was drawn.
pub(super) struct Drawn {
    /// The picture.
    pub(super) picture: DynamicImage,
    /// From an example: pixels that were synthesised anew.
    resynthesised: usize,
}

/// The picture, or the sheet of all materials, which is written too where the arguments say.
///
/// # Errors
/// As [`run`].
pub(super) fn drawn(args: &TextureArgs) -> Result<Drawn> {
    // Said before the work, not after it.
    args.output.as_deref().map(png_name).transpose()?;
    let drawn = match (args.example.is_empty(), &args.material) {
        (false, _) => from_examples(args)?,
        (true, Some(name)) => Drawn { picture: of_depth(args, of_material(args, name)?), resynthesised: 0 },
        (true, None) => {
            let sheet = contact_sheet(256, args.seed, args.noise, args.backend.device()?.as_ref())?;
            Drawn { picture: of_depth(args, sheet.into()), resynthesised: 0 }
        }
    };
    if let Some(output) = &args.output {
        write(args, &drawn.picture, output)?;
    }
    Ok(drawn)
}

fn write(args: &TextureArgs, picture: &DynamicImage, path: &Path) -> Result<()> {
    let overwrite = Overwrite::forced(args.force);
    write_atomically(path, overwrite, |writer| Ok(picture.write_with_encoder(PngEncoder::new(writer))?))
}

/// A picture of the depth that is wanted.
fn of_depth(args: &TextureArgs, picture: DynamicImage) -> DynamicImage {
    match (args.depth.as_str(), &picture) {
        ("16", _) => picture,
        (_, DynamicImage::ImageLuma16(_)) => picture.into_luma8().into(),
        _ => picture.into_rgb8().into(),
    }
}

fn list(args: &TextureArgs, output: Option<&Path>) -> Result<()> {
    for (kind, _, looks) in MaterialKind::CHOICES {
        say!("{kind:<10} {}", looks.trim_start());
    }
    let Some(output) = output else { return Ok(()) };
    drawn(args)?;
    say!("wrote {}", output.display());
    Ok(())
}

fn of_material(args: &TextureArgs, name: &str) -> Result<DynamicImage> {
    check_size(args.size).context("--size")?;
    let usual = Settings::default();
    let of_example = [
        ("--patch", args.patch != usual.patch),
        ("--overlap", args.overlap != usual.overlap),
        ("--delta-max", args.delta_max != usual.delta_max),
        ("--delta-pixel", args.delta_pixel != usual.delta_pixel),
        ("--mask", !args.mask.is_empty()),
        ("--decomposition", args.decomposition.is_some()),
        ("--resynthesised", args.resynthesised.is_some()),
    ];
    refuse_without("--example", &of_example)?;
    let object = args.preview.map(Preview::object);
    let is_on_object = matches!(object, Some(Object::Solid(_) | Object::Person));
    let scale = args.scale.unwrap_or(if is_on_object { 1.0 } else { 4.0 });
    let view = View { size: args.size, offset: args.offset, scale }.checked()?;
    let painted = args.palette.as_deref().map(|picture| with_palette(args, name, picture)).transpose()?;
    let parameters = match (&painted, args.params.as_deref()) {
        (Some(table), _) => Parameters::Table(table),
        (None, Some(file)) => Parameters::File(file),
        (None, None) => Parameters::Defaults,
    };
    let tile = args.tile.then(|| view.extent());
    let material = Material::of_noise(args.noise, name, parameters, args.seed, tile)?;
    let is_on_another = !matches!(args.preview, Some(Preview::Person));
    refuse_without("--preview person", &[("--person", args.person.is_some() && is_on_another)])?;
    let device = args.backend.device()?;
    let painter = Painter::new(&material, device.as_ref())?;
    Ok(match object {
        Some(Object::Solid(solid)) => lit(&painter, solid, args.size, args.offset, scale)?.into(),
        Some(Object::Person) => portrait(&painter, args.person.as_deref(), args.size, args.offset, scale)?.into(),
        Some(Object::Surface) => relief(&painter, &view)?.into(),
        None if args.height_map => painter.heights(&view)?.into(),
        None => painter.flat(&view)?.into(),
    })
}

/// The parameters of a material, in which bands of colour are a picture's.
fn with_palette(args: &TextureArgs, name: &str, path: &Path) -> Result<toml::Table> {
    let usual: toml::Table = MaterialKind::of(name)?.defaults()?.parse()?;
    ensure!(
        usual.contains_key("map"),
        "--palette is for materials with bands of colour by height (fractal, terrain), and {name} has none"
    );
    let mut parameters: toml::Table = match &args.params {
        Some(file) => read_toml(file)?,
        None => toml::Table::new(),
    };
    let bands = toml::Value::try_from(palette(&read(path)?.into_rgb8()))?;
    match parameters.entry("map").or_insert_with(|| toml::Table::new().into()) {
        toml::Value::Table(map) => map.insert("bands".into(), bands),
        other => bail!("--params: map is a {}, expected a table", other.type_str()),
    };
    Ok(parameters)
}

fn read(path: &Path) -> Result<DynamicImage> {
    const EXAMPLE: Limit = Limit { what: "a picture", most: 1 << 30 };
    let context = || format!("cannot read the picture {} ({PICTURE_FORMATS} are read)", path.display());
    let file = BufReader::new(EXAMPLE.open(path)?);
    let picture = image::ImageReader::new(file).with_guessed_format().with_context(context)?;
    picture.decode().with_context(context)
}

/// A picture of lights and darks that goes with an example.
fn read_beside(what: &str, path: &Path, example: &Path, size: (u32, u32)) -> Result<GrayImage> {
    let picture = DynamicImage::from(read(path)?.into_rgb8()).into_luma8();
    ensure!(
        picture.dimensions() == size,
        "the {what} {} has {} x {} pixels, expected the {} x {} of {}",
        path.display(),
        picture.width(),
        picture.height(),
        size.0,
        size.1,
        example.display()
    );
    Ok(picture)
}

/// The mask of an example; none where all of it may be used.
fn mask_of(given: Option<&String>, example: &Path, size: (u32, u32)) -> Result<Option<GrayImage>> {
    Ok(match given.map(String::as_str) {
        None | Some("ALL") => None,
        Some("IGNORE") => Some(GrayImage::new(size.0, size.1)),
        Some(path) => Some(read_beside("mask", Path::new(path), example, size)?),
    })
}

/// What of the first example is to be filled in: dark; none where a texture is made.
fn holes_of(args: &TextureArgs, path: &Path, example: &DynamicImage) -> Result<Option<GrayImage>> {
    let size = (example.width(), example.height());
    if let Some(channel) = args.inpaint_channel {
        ensure!(
            channel != Channel::Alpha || example.color().has_alpha(),
            "{} has no transparency, expected a picture with an opacity for --inpaint-channel a",
            path.display()
        );
        let channels = example.to_rgba8();
        return Ok(Some(GrayImage::from_fn(size.0, size.1, |x, y| {
            image::Luma([channels.get_pixel(x, y).0[channel.index()]])
        })));
    }
    args.inpaint.as_deref().map(|holes| read_beside("picture of holes", holes, path, size)).transpose()
}

fn from_examples(args: &TextureArgs) -> Result<Drawn> {
    let of_material = [
        ("--params", args.params.is_some()),
        ("--preview", args.preview.is_some()),
        ("--height-map", args.height_map),
        ("--scale", args.scale.is_some()),
        ("--depth 16", args.depth == "16"),
        ("--noise", args.noise != NoiseWay::default()),
    ];
    refuse_with("--example", &of_material)?;
    ensure!(
        args.mask.len() <= args.example.len(),
        "{} masks for {} examples, expected at most one for each",
        args.mask.len(),
        args.example.len()
    );
    let decoded: Vec<DynamicImage> = args.example.iter().map(|path| read(path)).collect::<Result<_>>()?;
    let masks: Vec<Option<GrayImage>> = (0..decoded.len())
        .map(|i| mask_of(args.mask.get(i), &args.example[i], (decoded[i].width(), decoded[i].height())))
        .collect::<Result<_>>()?;
    let holes = match (decoded.first(), args.example.first()) {
        (Some(picture), Some(path)) => holes_of(args, path, picture)?,
        _ => None,
    };
    let settings = Settings {
        size: holes.as_ref().map_or(args.size, |holes| [holes.width(), holes.height()]),
        patch: args.patch,
        overlap: args.overlap,
        delta_max: args.delta_max,
        delta_pixel: args.delta_pixel,
        seed: args.seed,
        tile: args.tile,
    };
    let pictures: Vec<RgbImage> = decoded.into_iter().map(DynamicImage::into_rgb8).collect();
    let examples: Vec<Example<'_>> =
        pictures.iter().zip(&masks).map(|(picture, mask)| Example { picture, mask: mask.as_ref() }).collect();
    let device = args.backend.device()?;
    let mut progress = ProgressBar::of("texture", "patch", patch_count(&settings));
    let names = || args.example.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ");
    let synthesis = synthesise(&examples, holes.as_ref(), &settings, device.as_ref(), || progress.advance())
        .with_context(|| format!("cannot synthesise from {}", names()))?;
    drop(progress);
    for (path, picture) in
        [(&args.decomposition, synthesis.decomposition), (&args.resynthesised, synthesis.resynthesised)]
    {
        if let Some(path) = path {
            write(args, &picture.into(), path)?;
        }
    }
    Ok(Drawn { picture: synthesis.picture.into(), resynthesised: synthesis.resynthesised_count })
}
