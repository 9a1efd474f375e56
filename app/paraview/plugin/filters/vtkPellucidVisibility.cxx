#include "vtkPellucidVisibility.h"

#include <algorithm>

#include "image_on_ranks.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

vtkStandardNewMacro(vtkPellucidVisibility);

vtkPellucidVisibility::vtkPellucidVisibility() {
    this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

int vtkPellucidVisibility::FillInputPortInformation(int, vtkInformation* info) {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
    return 1;
}

int vtkPellucidVisibility::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
    namespace pv = pellucid::paraview;
    vtkImageData* const input = vtkImageData::GetData(inputs[0]);
    vtkImageData* const output = vtkImageData::GetData(outputs);
    const pv::Asked asked = pv::askedOf(*this);

    pv::Seen seen;
    const std::string problem = pv::runOnRanks(this->Threads, [&](pellucid::Communicator& ranks) {
        const pv::ImagePiece image(input, this->GetInputArrayToProcess(0, inputs));
        const pv::Prepared prepared = pv::prepared(ranks, image, asked);
        seen = pv::seenOf(ranks, prepared);
    });
    if (!problem.empty()) {
        vtkErrorMacro(<< problem);
        return 0;
    }
    output->ShallowCopy(input);
    for (const pv::PieceField& field : seen.fields) {
        vtkNew<vtkFloatArray> values;
        values->SetName(field.name.c_str());
        values->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()));
        std::copy(field.values.begin(), field.values.end(), values->GetPointer(0));
        output->GetPointData()->AddArray(values);
    }
    vtkNew<vtkStringArray> names;
    names->SetName("feature");
    for (const std::string& name : seen.features) names->InsertNextValue(name);
    output->GetFieldData()->AddArray(names);
    const auto addFigures = [&](const char* name, const std::vector<double>& figures) {
        vtkNew<vtkDoubleArray> values;
        values->SetName(name);
        for (const double figure : figures) values->InsertNextValue(figure);
        output->GetFieldData()->AddArray(values);
    };
    addFigures("feature_visibility", seen.visibility);
    addFigures("feature_vws", seen.vws);
    return 1;
}

void vtkPellucidVisibility::PrintSelf(ostream& os, vtkIndent indent) {
    this->Superclass::PrintSelf(os, indent);
    os << indent << "TransferFunction: " << this->TransferFunction << "\n";
    os << indent << "ByDirection: " << this->ByDirection << "\n";
    os << indent << "Direction: " << this->Direction[0] << ", " << this->Direction[1] << "\n";
    os << indent << "Threads: " << this->Threads << "\n";
}
