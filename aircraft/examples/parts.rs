#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
use engine::rotors::*; use engine::math::*;
use std::hint::black_box as bb;
fn time(name:&str, mut f: impl FnMut()) { let mut best=f64::MAX; for _ in 0..20 { let t=std::time::Instant::now(); for _ in 0..5000 { f(); } best=best.min(t.elapsed().as_nanos() as f64/5000.0); } println!("{name}: {best:.0} ns"); }
fn main() {
    let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap(); let p=&x.rotors;
    let i=lab::inputs(589.0, 10.0/57.3); let (s,_)=lab::settle(p,&i);
    time("rotor", || { bb(rotor(p,&p.blade(),bb(&s),bb(&i))); });
    time("blade", || { bb(blade::blade(bb(&p.blade), p.radius_m)); });
    let b=blade::blade(&p.blade,p.radius_m);
    let flow=elements::Flow{omega_radps:61.7,forward_mps:1.0,right_mps:0.5,along_mps:1.0,density_kg_per_m3:1.225,sound_speed_mps:340.0};
    let pass=inflow::passage(&s.inflow,&flow);
    time("induced", || { bb(inflow::induced(&p.inflow,bb(&s.inflow),&pass,bb(&flow),&b,((sin(0.17),cos(0.17)),3.0),(1.0,p.radius_m))); });
    let ind=inflow::induced(&p.inflow,&s.inflow,&pass,&flow,&b,((sin(0.17),cos(0.17)),3.0),(1.0,p.radius_m));
    let pitch=elements::Pitch{collective_rad:0.17,forward_rad:0.01,right_rad:0.01};
    time("elements", || { bb(elements::elements(bb(&b),bb(&flow),bb(&pitch),bb(&s.flapping),bb(&ind))); });
    time("sin", || { bb(sin(bb(0.7))); });
}
