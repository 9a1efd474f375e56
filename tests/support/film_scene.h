// A small scene that films are made of, and keyframes.
#pragma once

#include "render/standard_view.h"
#include "session/keyframes.h"
#include "session/scene.h"

namespace pellucid::test {

inline Scene sampleScene(const std::string& sample = "sample:shells", int size = 12) {
    VolumeSource source;
    source.path = sample;
    source.sampleSize = size;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3";
    inputs.start = SceneInputs::Start::Tents;
    inputs.view = ViewAngles{30, 20, 1};
    return openScene(inputs);
}

/// The same, drawn without a GPU.
inline Scene filmScene(const std::string& sample = "sample:shells", int size = 12) {
    Scene scene = sampleScene(sample, size);
    scene.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    return scene;
}

/// From one side to another while a feature fades, the volume is cut open and lit.
inline Keyframes twoKeys(const Scene& scene, double seconds, Easing easing = Easing::Linear) {
    Keyframe from{0, "whole", easing}, to{seconds, "open"};
    from.state = to.state = keyStateOf(scene);
    to.state.camera = cameraFromView(scene.volume->geometry(), 120, -10, 1.5, Projection::Perspective);
    to.state.tf.points[1].opacity = 0.05;
    to.state.clipping.hi.x = 0.6;
    to.state.light.on = true;
    return {from, to};
}

} // namespace pellucid::test
