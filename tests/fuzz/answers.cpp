// Answers of participants of a study, and the tables that they are.
#include "study/answers.h"
#include "base/csv.h"
#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

void requireSameTable(const CsvRecords& table) {
    CsvTable again;
    for (const std::vector<std::string>& record : table.records) {
        for (const std::string& field : record) again << std::string_view(field);
        again.endLine();
    }
    require(readCsv(again.text()).records == table.records, "a table is read back as it was");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = fuzz::textOf(data, size);
    requireSameTable(readCsv(text));
    succeeds([&] {
        const AnswersRead read = answersFrom(text, "p1.csv");
        require(read.wholeBytes <= size, "whole lines are in the file");
        std::string again = answersHead();
        for (const Answer& answer : read.participant.answers) again += lineOf(read.participant, answer);
        answersFrom(again, "p1.csv");
    });
    return 0;
}
