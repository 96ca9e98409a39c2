//! Drawing a frame of four views of 640 x 480, by the processor's one thread and by the device that `PANTIN_DEVICE` names or the
//! first there is.
#![allow(missing_docs, reason = "criterion_group! makes an undocumented function")]
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a bench may unwrap and say what it leaves out")]

use criterion::{Criterion, criterion_group, criterion_main};
use pantin::body::Body;
use pantin::evaluate::device::open_device;
use pantin::gpu::by_name;
use pantin::synth::device::DevicePainter;
use pantin::synth::figure::{Figure, Wardrobe};
use pantin::synth::render::{Cast, View};
use pantin::synth::room::Room;
use pantin::synth::{Scene, rig};

fn of_frames(criterion: &mut Criterion) {
    let scene = Scene::preset("leewalk").unwrap();
    let room = Room::new(&scene.room).unwrap();
    let cameras = rig::cameras(&scene.rig, &room).unwrap();
    let views: Vec<View> = cameras.iter().map(|camera| View::new(camera, &room).unwrap()).collect();
    let actor = &scene.actor[0];
    let body = Body::adult(actor.height).unwrap();
    let wardrobe = Wardrobe::new(&actor.clothes).unwrap();
    let figures = [Figure::of_solids(&body, actor.height, wardrobe).unwrap()];
    let placed = [figures[0].place(&body.standing_pose()).unwrap()];
    let mut group = criterion.benchmark_group("four views of 640 x 480");
    group.sample_size(10);
    group.bench_function("processor, one thread", |b| {
        b.iter(|| {
            let cast = Cast::new(&placed, None).unwrap();
            views.iter().map(|view| view.picture(&cast)).collect::<Vec<_>>()
        });
    });
    match open_device().and_then(|device| DevicePainter::new(&device, &views, &figures)) {
        Ok(painter) => {
            group.bench_function("device", |b| {
                b.iter(|| {
                    let cast = Cast::new(&placed, None).unwrap();
                    painter.pictures(&cast, &views, &[true; 4]).unwrap()
                });
            });
            for (pass, ms, _) in by_name(&painter.timings().unwrap()) {
                eprintln!("{pass}: {ms:.2} ms by the time stamps around it");
            }
        }
        Err(error) => eprintln!("no device: {error:#}"),
    }
    group.finish();
}

criterion_group!(synth, of_frames);
criterion_main!(synth);
