//! `pantin devices`.

use anyhow::Result;
use serde_json::{Value, json};

use super::output::say;
use crate::bench::Scene;
use crate::evaluate::device::kept_kernels;
use crate::gpu::{DeviceFacts, Instance, Validation, devices};
use crate::track::{Drawing, makes_features};

/// Lists the Vulkan devices of this machine in Vulkan's order: what each can do, whether pantin can use it, what it lacks;
/// and which backend --backend auto would take on a built-in scene, and why. Without Vulkan the list is empty.
#[derive(clap::Args, Debug)]
pub(super) struct DevicesArgs {
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// When not even the processor can evaluate.
pub(super) fn run(args: &DevicesArgs) -> Result<()> {
    let found = Instance::open(Validation::Off).and_then(|instance| devices(&instance));
    let scene = Scene::new([640, 480], 280.0)?;
    let auto = Drawing::default().build(&[], None, &scene.body, &scene.cameras, &scene.pose)?;
    let backend = auto.evaluator.name();
    if args.json {
        let list: Vec<Value> = found.iter().flatten().map(object).collect();
        let object = json!({ "devices": list, "auto": { "backend": backend, "reason": auto.reason } });
        say!("{}", serde_json::to_string_pretty(&object)?);
        return Ok(());
    }
    match &found {
        Err(error) => say!("{error:#}"),
        Ok(found) if found.is_empty() => {
            say!("Vulkan finds no device on this machine: install a driver (Debian: mesa-vulkan-drivers)")
        }
        Ok(found) => print_table(found),
    }
    say!("\nwith --backend auto: {}", auto.reason);
    Ok(())
}

fn object(device: &DeviceFacts) -> Value {
    json!({
        "index": device.index,
        "name": device.name,
        "type": device.kind.name(),
        "vulkan": version(device),
        "driver": device.driver,
        "subgroup_size": device.capabilities.subgroup_size,
        "max_image": device.capabilities.max_image,
        "memory_mb": device.capabilities.memory / (1 << 20),
        "usable": device.usable,
        "reasons": device.reasons,
    })
}

fn version(device: &DeviceFacts) -> String {
    device.vulkan.map(|part| part.to_string()).join(".")
}

fn print_table(found: &[DeviceFacts]) {
    let mut rows = vec![
        ["index", "name", "type", "vulkan", "driver", "subgroup", "max image", "memory MB", "usable"]
            .map(str::to_string),
    ];
    rows.extend(found.iter().map(|device| {
        [
            device.index.to_string(),
            device.name.clone(),
            device.kind.name().to_string(),
            version(device),
            device.driver.clone(),
            device.capabilities.subgroup_size.to_string(),
            device.capabilities.max_image.to_string(),
            (device.capabilities.memory / (1 << 20)).to_string(),
            if device.usable { "yes" } else { "no" }.to_string(),
        ]
    }));
    let widths: [usize; 9] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    for (index, row) in rows.iter().enumerate() {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        say!("{}", cells.join("  ").trim_end());
        let reasons = index.checked_sub(1).map_or(&[][..], |device| &found[device].reasons);
        let kept = index.checked_sub(1).map(|device| kept_kernels(&found[device])).unwrap_or_default();
        let made = index.checked_sub(1).map(|device| features_made(&found[device]));
        for sentence in reasons.iter().chain(&kept).map(String::as_str).chain(made) {
            say!("       - {sentence}");
        }
    }
}

/// Who makes the features of a run that is searched on a device.
fn features_made(device: &DeviceFacts) -> &'static str {
    if makes_features(device.kind) {
        "track makes the features there, and what is compared stays there"
    } else {
        "track leaves the features to the processor, of which the device is a part (--features device)"
    }
}
