#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
use engine::frames::Vec3;
fn main() { let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap(); let p=&x.rotors;
  for (v,rpm,c,t) in [(0.0,589.0,11.5,0.0),(92.4,458.0,35.5,1.5708),(72.0,458.0,29.0,1.5708),(113.0,458.0,40.8,1.5708),(72.0,589.0,23.0,1.5708),(40.0,589.0,15.0,0.7)] {
    let f=|c:f64,om:f64| { let mut i=lab::inputs(rpm+om, c/57.29578); i.mast_tilt_rad=t; i.motion.airspeed_mps=Vec3::new(v,0.0,0.0); lab::settle(p,&i).1 };
    let (a,b)=(f(c-0.5,0.0),f(c+0.5,0.0)); let (d,e)=(f(c,-2.0),f(c,2.0));
    println!("V {v} rpm {rpm} c {c}: T {:.0} Q {:.0} P2 {:.0} dQ/dth {:.0} Nm/deg dT/dth {:.0} N/deg dQ/drpm {:.1}", 0.5*(a.thrust_n+b.thrust_n), 0.5*(a.torque_n_m+b.torque_n_m), (a.power_w+b.power_w)*1e-3, b.torque_n_m-a.torque_n_m, b.thrust_n-a.thrust_n, (e.torque_n_m-d.torque_n_m)/4.0); } }
