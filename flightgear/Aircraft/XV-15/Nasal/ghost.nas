# A second XV-15 beside the first: it appears when something comes for it, and stays where it was last.

var ghost_listener = setlistener("/ghost/tiltrotor/tick", func {
    if (!getprop("/ghost/tiltrotor/schema")) return;
    removelistener(ghost_listener);
    var place = "/ghost/tiltrotor/";
    for (var i = 0; props.globals.getNode("/models/model[" ~ i ~ "]") != nil; i += 1) {}
    var model = props.globals.getNode("/models/model[" ~ i ~ "]", 1);
    model.setValues({
        "path": "Aircraft/XV-15/Models/ghost.xml",
        "latitude-deg-prop": place ~ "position/latitude-deg",
        "longitude-deg-prop": place ~ "position/longitude-deg",
        "elevation-ft-prop": place ~ "air/altitude-ft",
        "heading-deg-prop": place ~ "attitude/heading-deg",
        "pitch-deg-prop": place ~ "attitude/pitch-deg",
        "roll-deg-prop": place ~ "attitude/roll-deg",
    });
    # FlightGear loads it when this appears.
    model.getNode("load", 1);
}, 0, 0);
