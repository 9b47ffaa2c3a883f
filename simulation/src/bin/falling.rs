//! probe
use sweep_and_prune_simulation::{scenes::*, *};
fn run<const D: usize>(n: u32, steps: u32, size: f32, spread: f32, e: f32) {
    let mut setup = falling::<D>(Population { bodies: n, size, spread, seed: 1 }).unwrap();
    setup.restitution = e; if let Ok(s) = std::env::var("G") { setup.gravity[1] = -s.parse::<f32>().unwrap(); }
    if let Ok(s) = std::env::var("SUB") { setup.substeps = s.parse().unwrap(); }
    println!("bounds {:?}", setup.bounds);
    let t0 = std::time::Instant::now();
    let mut sim = Simulation::new(&setup).unwrap();
    println!("made {:?}", t0.elapsed());
    sim.set_counting(false);
    let now = || t0.elapsed().as_secs_f64() * 1e3;
    let e0 = sim.energy();
    println!("E0 {:?}", e0);
    let mut least = e0.total();
    let mut rise = 0.0f64; let mut last = e0.total(); let mut up = 0.0f64;
    let (mut bp, mut np, mut tot) = (0.0, 0.0, 0.0);
    for step in 1..=steps {
        let r = sim.step(now).unwrap();
        bp += r.broad_phase_ms; np += r.narrow_phase_ms; tot += r.total_ms;
        let en = sim.energy();
        let t = en.total();
        if t > last { up += t - last; }
        last = t;
        rise = rise.max(t - least); least = least.min(t);
        if step % (steps / 20).max(1) == 0 {
            let mut pen = 0.0f32; let mut mean = 0.0; let mut cnt = 0;
            for &[a, b] in sim.pairs() { let (a, b) = (a as usize, b as usize);
                let p = sim.positions(); let d: f32 = (0..D).map(|k| (p[a][k] - p[b][k]).powi(2)).sum::<f32>().sqrt();
                let o = (sim.radii()[a] + sim.radii()[b] - d) / sim.radii()[a].min(sim.radii()[b]);
                if o > 0.0 { mean += o; cnt += 1; }
                pen = pen.max(o); }
            let vmax = sim.velocities().iter().map(|v| v.iter().map(|x| x * x).sum::<f32>().sqrt()).fold(0.0, f32::max);
            println!("{step:5} kin {:.3e} pot {:.5} vmax {vmax:.3} pairs {} contacts {} pen max {pen:.3} mean {:.4} up {up:.2e} rise {rise:.2e}", en.kinetic, en.potential, r.pairs, r.contacts, mean / cnt.max(1) as f32);
        }
    }
    println!("ms/step: broad {:.2} narrow {:.2} total {:.2}; hash {:016x}", bp / steps as f64, np / steps as f64, tot / steps as f64, sim.hash());
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let g = |i: usize, d: f32| a.get(i).map_or(d, |s| s.parse().unwrap());
    let (d, n, steps, size, spread, e) = (g(1, 3.0) as u32, g(2, 10000.0) as u32, g(3, 600.0) as u32, g(4, 0.2), g(5, 1.0), g(6, 0.4));
    if d == 3 { run::<3>(n, steps, size, spread, e) } else { run::<2>(n, steps, size, spread, e) }
}
