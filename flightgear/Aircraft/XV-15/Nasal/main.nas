# Views and fields of view by key, and what other scripts of the package there are.

# Goes to a view by its name.
var view_named = func(name) {
    forindex (var i; view.views) {
        if (view.views[i].getNode("name").getValue() != name) continue;
        setprop("/sim/current-view/view-number", i);
        return;
    }
};

# Fields of view, deg: narrow to look far, wide to see the ground beside the nose.
var FIELDS_DEG = [40, 55, 76, 95, 115];

var next_field = func {
    var now = getprop("/sim/current-view/field-of-view");
    var next = FIELDS_DEG[0];
    foreach (var deg; FIELDS_DEG) {
        if (deg > now + 0.5) {
            next = deg;
            break;
        }
    }
    setprop("/sim/current-view/field-of-view", next);
    gui.popupTip(sprintf("field of view %d deg", next), 1);
};

# The heights of FlightGear's ground go back to the flight, where the package has that script.
var more = getprop("/sim/aircraft-dir") ~ "/Nasal/ground.nas";
if (io.stat(more) != nil) io.load_nasal(more, "tiltrotor_ground");
