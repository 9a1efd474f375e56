#include "vtkPellucidOptimize.h"

#include <algorithm>

#include "image_on_ranks.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

vtkStandardNewMacro(vtkPellucidOptimize);

vtkPellucidOptimize::vtkPellucidOptimize() {
    this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

int vtkPellucidOptimize::FillInputPortInformation(int, vtkInformation* info) {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
    return 1;
}

int vtkPellucidOptimize::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
    namespace pv = pellucid::paraview;
    vtkImageData* const input = vtkImageData::GetData(inputs[0]);
    vtkTable* const output = vtkTable::GetData(outputs);
    const pv::Asked asked = pv::askedOf(*this);

    pv::Answer answer;
    const std::string problem = pv::runOnRanks(this->Threads, [&](pellucid::Communicator& ranks) {
        const pv::ImagePiece image(input, this->GetInputArrayToProcess(0, inputs));
        const pv::Prepared prepared = pv::prepared(ranks, image, asked);
        answer = pv::optimized(ranks, prepared, this->Targets, this->OutputFile);
    });
    if (!problem.empty()) {
        vtkErrorMacro(<< problem);
        return 0;
    }
    const auto addNumbers = [&](const char* name, const std::vector<double>& figures) {
        vtkNew<vtkDoubleArray> values;
        values->SetName(name);
        for (const double figure : figures) values->InsertNextValue(figure);
        output->AddColumn(values);
    };
    vtkNew<vtkStringArray> names;
    names->SetName("feature");
    for (const std::string& name : answer.features) names->InsertNextValue(name);
    output->AddColumn(names);
    addNumbers("target", answer.targets);
    addNumbers("vws_before", answer.vwsBefore);
    addNumbers("vws_after", answer.vwsAfter);
    addNumbers("opacity_before", answer.opacityBefore);
    addNumbers("opacity_after", answer.opacityAfter);

    vtkNew<vtkStringArray> preset;
    preset->SetName("preset");
    preset->InsertNextValue(answer.preset);
    output->GetFieldData()->AddArray(preset);
    vtkNew<vtkDoubleArray> unit;
    unit->SetName("opacity_unit_distance");
    unit->InsertNextValue(answer.unitDistance);
    output->GetFieldData()->AddArray(unit);
    return 1;
}

void vtkPellucidOptimize::PrintSelf(ostream& os, vtkIndent indent) {
    this->Superclass::PrintSelf(os, indent);
    os << indent << "TransferFunction: " << this->TransferFunction << "\n";
    os << indent << "Targets: " << this->Targets << "\n";
    os << indent << "OutputFile: " << this->OutputFile << "\n";
    os << indent << "ByDirection: " << this->ByDirection << "\n";
    os << indent << "Direction: " << this->Direction[0] << ", " << this->Direction[1] << "\n";
    os << indent << "Threads: " << this->Threads << "\n";
}
