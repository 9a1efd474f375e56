/**
 * @class vtkPellucidVisibility
 * @brief what of an image is seen, and what of it catches the eye
 *
 * Adds point arrays to a distributed image: visibility, the light that reaches the eye from each point; saliency, how
 * much its colour differs from those around; vws, its share of the visibility-weighted saliency; and vws_NAME, that of
 * each feature. Field data: feature, feature_visibility and feature_vws, the shares of the features.
 */
#ifndef vtkPellucidVisibility_h
#define vtkPellucidVisibility_h

#include "PellucidParaViewFiltersModule.h" // for export macro
#include "vtkImageAlgorithm.h"

#include <string> // for std::string

class PELLUCIDPARAVIEWFILTERS_EXPORT vtkPellucidVisibility : public vtkImageAlgorithm {
public:
    static vtkPellucidVisibility* New();
    vtkTypeMacro(vtkPellucidVisibility, vtkImageAlgorithm);
    void PrintSelf(ostream& os, vtkIndent indent) override;

    ///@{
    /** A file (*.tf.json, *.tfi), tents:N[:PEAK], preset:NAME, or auto: what the data propose. */
    vtkSetStdStringFromCharMacro(TransferFunction);
    vtkGetCharFromStdStringMacro(TransferFunction);
    ///@}
    ///@{
    /** Where it is seen from: azimuth and elevation in degrees, or position, focal point and so on of a camera. */
    vtkSetMacro(ByDirection, bool);
    vtkGetMacro(ByDirection, bool);
    vtkSetVector2Macro(Direction, double);
    vtkGetVector2Macro(Direction, double);
    vtkSetVector3Macro(CameraPosition, double);
    vtkGetVector3Macro(CameraPosition, double);
    vtkSetVector3Macro(CameraFocalPoint, double);
    vtkGetVector3Macro(CameraFocalPoint, double);
    vtkSetVector3Macro(CameraViewUp, double);
    vtkGetVector3Macro(CameraViewUp, double);
    vtkSetMacro(CameraViewAngle, double);
    vtkGetMacro(CameraViewAngle, double);
    vtkSetMacro(ParallelProjection, bool);
    vtkGetMacro(ParallelProjection, bool);
    vtkSetMacro(ParallelScale, double);
    vtkGetMacro(ParallelScale, double);
    ///@}
    ///@{
    /** Of each process; 0: what its machine has for it. */
    vtkSetClampMacro(Threads, int, 0, 1024);
    vtkGetMacro(Threads, int);
    ///@}

protected:
    vtkPellucidVisibility();
    ~vtkPellucidVisibility() override = default;
    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
    int FillInputPortInformation(int port, vtkInformation* info) override;

private:
    vtkPellucidVisibility(const vtkPellucidVisibility&) = delete;
    void operator=(const vtkPellucidVisibility&) = delete;

    std::string TransferFunction = "auto";
    bool ByDirection = true;
    double Direction[2] = {30, 20};
    double CameraPosition[3] = {0, 0, 1};
    double CameraFocalPoint[3] = {0, 0, 0};
    double CameraViewUp[3] = {0, 1, 0};
    double CameraViewAngle = 30;
    bool ParallelProjection = false;
    double ParallelScale = 1;
    int Threads = 0;
};

#endif
