// fuzz_document_seeds FOLDER: transfer functions, sessions and other documents as our own writers and the tests make
// them.
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "render/camera.h"
#include "report/reproduction.h"
#include "seeds.h"
#include "session/session_json.h"
#include "study/answers.h"
#include "support/random_sessions.h"
#include "support/study_cases.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using namespace pellucid::test;
using fuzz::Seeds;

namespace {

void addDocuments(Seeds& seeds) {
    const TempFolder folder;
    for (std::uint32_t n = 1; n <= 24; ++n) {
        Random random(n);
        seeds.add("tf_json", jsonFromTf(randomTf(random)).dump());
        writeSession(randomSession(n), folder.path("a.json"));
        seeds.add("session_json", fuzz::bytesIn(folder.path("a.json")));
    }
    writeSession(Session{}, folder.path("a.json"));
    seeds.add("session_json", fuzz::bytesIn(folder.path("a.json")));
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic})
        seeds.add("camera_json", jsonFromCamera({projection}).dump());
    Study study = studyOf(1, 3, 1);
    study.stimuli[1].vws = study.stimuli[1].fs = 0.25;
    study.stimuli[2].color = Rgb{1, 0.5, 0.123456789};
    study.stimuli[3].view = "30,20,1.5";
    writeStudy(study, folder.path("a.json"));
    seeds.add("study_json", fuzz::bytesIn(folder.path("a.json")));
    const Participant person{"p1", ColorVision::Unsure, {}};
    Answer answer;
    answer.stimulus = "a1";
    answer.feature = "bone, \"hard\"\nand =thick";
    answer.score = 4;
    answer.time = "2026-11-25T03:14:15Z";
    seeds.add("answers", answersHead() + lineOf(person, answer) + lineOf(person, answer) + "p1,3");
    Reproduction item;
    item.equations = {{"4.12", "src/saliency/vws.cpp"}};
    item.pictures = {{"left.png", "4.5 (a)", "left"}};
    item.numbers = {{"moves", 3, 2, "moves"}};
    item.tables = {{"Shares", {"feature", "VWS"}, {{"a", "0.5"}}}};
    item.statements = {{"A < B.", "4.3.5", true, "0.2 < 0.5"}};
    item.commands = {{"pellucid-cli samples", 1.5}};
    seeds.add("reproduction_json", jsonFromReproduction(item).dump());
}

void addVoreen(Seeds& seeds) {
    const auto key = [](const char* x, const char* more) {
        return std::string("<key type=\"TransFuncMappingKey\"><intensity value=\"") + x +
               "\"/><colorL r=\"255\" g=\"102\" b=\"0\" a=\"51\"/>" + more + "</key>\n";
    };
    const std::string split = "<split value=\"true\"/><colorR r=\"1\" g=\"2\" b=\"3\" a=\"255\"/>";
    seeds.add("tfi", "<VoreenData version=\"1\">\n<TransFuncIntensity type=\"TransFuncIntensity\">\n"
                     "<alphaMode value=\"1\"/><gammaValue value=\"1.5\"/><domain x=\"-1000\" y=\"3000\"/>"
                     "<threshold x=\"0.1\" y=\"0.9\"/>\n<Keys>\n" +
                         key("0.2", "") + key("0.4", split.c_str()) + key("0.6", "<split value=\"false\"/>") +
                         "</Keys></TransFuncIntensity></VoreenData>\n");
}

void addWords(Seeds& seeds) {
    for (const char* words : {"64,64,48,u16,big", "+x-z+y", "x,y,-z", "curl(u,v,w)", "u - v", "30,-20,1.5", "front,2",
                              "tents:3:0.5", "ramp:8", "preset:bone", "#12aBff", "\xe2\x80\xae\x1b[0m\xff"})
        seeds.add("words", words);
}

} // namespace

int main(int argc, char** argv) {
    return fuzz::writeSeeds(argc, argv, [](Seeds& seeds) {
        addDocuments(seeds);
        addVoreen(seeds);
        addWords(seeds);
    });
}
