# Views and fields of view by key.

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

# One of several screens: how far it looks to the left of ahead, deg. All look level, or their edges
# would not meet.
var screen_listener = setlistener("/sim/signals/fdm-initialized", func {
    var heading = getprop("/sim/tiltrotor/screen-heading-deg");
    if (heading == nil) return;
    foreach (var place; ["/sim/view[0]/config/", "/sim/current-view/", "/sim/current-view/goal-"]) {
        setprop(place ~ "heading-offset-deg", heading);
        setprop(place ~ "pitch-offset-deg", 0);
    }
}, 1, 0);
