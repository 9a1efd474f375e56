// Small studies on disk, prepared or not.
#pragma once

#include <string>

#include "base/image.h"
#include "image_io/image_file.h"
#include "study/study.h"
#include "support/temp_folder.h"

namespace pellucid::test {

/// `training` stimuli t1, t2, …, then `count` others a1, a2, …, all of them the feature f1 of sample:shells.
inline Study studyOf(int training, int count, int repeats = 0) {
    Study study;
    study.repeats = repeats;
    study.width = study.height = 32;
    for (int i = 0; i < training + count; ++i) {
        Stimulus s;
        s.training = i < training;
        s.id = s.training ? "t" + std::to_string(i + 1) : "a" + std::to_string(i - training + 1);
        s.volume = "sample:shells";
        s.tf = "tents:3";
        s.feature = "f1";
        s.label = "RED";
        study.stimuli.push_back(s);
    }
    return study;
}

/// The study as if it had been prepared: pictures of one grey and figures that grow from stimulus to stimulus.
inline Study writePrepared(Study study, const TempFolder& folder) {
    std::filesystem::create_directories(picturesFolder(folder.path("")));
    double figure = 0.1;
    for (Stimulus& s : study.stimuli) {
        s.picture = picturesFolder(folder.path("")) + "/" + s.id + ".png";
        Image image(study.width, study.height);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) std::fill_n(image.pixel(x, y), 4, 1.0f);
        writeImage(image, s.picture);
        s.vws = s.visibility = s.fs = figure;
        s.engine = "cpu";
        figure += 0.01;
    }
    writeStudy(study, preparedStudyFile(folder.path("")));
    return study;
}

} // namespace pellucid::test
