# The ground under the wheels, for the flight model outside: heights of the terrain, and how often they
# were looked up. Nothing is looked up before the scenery is there.

# Nose, left and right wheel from the reference point: forward and right, m. A test holds them to the
# aircraft file.
var wheels = [[4.1707, 0.0], [-0.6299, -1.1938], [-0.6299, 1.1938]];
# Higher above the ground than this, a few times a second are enough, m.
var near_m = 150.0;
# What is found higher than this over the aircraft is no ground under it, m.
var above_m = 50.0;
var metres_per_degree = 111319.49;

var samples = 0;
var skipped = 0;

var sample = func {
    if (!getprop("sim/sceneryloaded") or getprop("tiltrotor/tick") == nil) return;
    var agl_ft = getprop("position/altitude-agl-ft") or 0;
    skipped += 1;
    if (agl_ft * 0.3048 > near_m and skipped < 10) return;
    skipped = 0;
    var latitude = getprop("position/latitude-deg");
    var longitude = getprop("position/longitude-deg");
    var heading = (getprop("orientation/heading-deg") or 0) * math.pi / 180;
    var height_m = (getprop("position/altitude-ft") or 0) * 0.3048;
    var north = math.cos(heading);
    var east = math.sin(heading);
    var parallel = metres_per_degree * math.cos(latitude * math.pi / 180);
    var heights = [];
    foreach (var wheel; wheels) {
        var found = geodinfo(
            latitude + (wheel[0] * north - wheel[1] * east) / metres_per_degree,
            longitude + (wheel[0] * east + wheel[1] * north) / parallel,
            height_m + above_m);
        if (found == nil) return;
        append(heights, found[0]);
    }
    forindex (var i; heights) setprop("tiltrotor/ground/wheel[" ~ i ~ "]/height-m", heights[i]);
    setprop("tiltrotor/ground/latitude-deg", latitude);
    setprop("tiltrotor/ground/longitude-deg", longitude);
    samples += 1;
    setprop("tiltrotor/ground/samples", samples);
};

var ground_timer = maketimer(0.0, sample);
ground_timer.simulatedTime = 0;
var ground_listener = setlistener("sim/signals/fdm-initialized", func { ground_timer.start(); }, 1);
