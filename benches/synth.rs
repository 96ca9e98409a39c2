//! Drawing a frame of four views of 640 x 480, by the processor's one thread and by the device that `PANTIN_DEVICE` names or the
//! first there is.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark ends where something fails, and prints")]

mod table;

use pantin::body::Body;
use pantin::evaluate::device::open_device;
use pantin::gpu::by_name;
use pantin::synth::device::DevicePainter;
use pantin::synth::figure::{Figure, Wardrobe};
use pantin::synth::render::{Cast, View};
use pantin::synth::room::Room;
use pantin::synth::{Scene, rig};
use table::Table;

fn main() {
    let scene = Scene::preset("leewalk").unwrap();
    let room = Room::new(&scene.room).unwrap();
    let cameras = rig::cameras(&scene.rig, &room).unwrap();
    let views: Vec<View> = cameras.iter().map(|camera| View::new(camera, &room).unwrap()).collect();
    let actor = &scene.actor[0];
    let body = Body::adult(actor.height).unwrap();
    let wardrobe = Wardrobe::new(&actor.clothes).unwrap();
    let figures = [Figure::of_solids(&body, actor.height, wardrobe).unwrap()];
    let placed = [figures[0].place(&body.standing_pose()).unwrap()];
    let cast = || Cast::new(&placed, None).unwrap();
    let device = open_device().and_then(|device| DevicePainter::new(&device, &views, &figures));
    let mut table = Table::new("four views of 640 x 480", "view");
    table.row("processor, one thread", views.len(), || {
        let cast = cast();
        views.iter().map(|view| view.picture(&cast)).collect::<Vec<_>>()
    });
    match &device {
        Ok(painter) => {
            let draw = || painter.pictures(&cast(), &views, &[true; 4]).unwrap();
            draw();
            for (pass, ms, _) in by_name(&painter.timings().unwrap()) {
                println!("{pass}: {ms:.2} ms by the time stamps around it");
            }
            table.row("device", views.len(), draw);
        }
        Err(error) => println!("SKIPPED the device: {error:#}"),
    }
    table.run();
}
