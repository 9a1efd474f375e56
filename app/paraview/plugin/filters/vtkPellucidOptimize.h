/**
 * @class vtkPellucidOptimize
 * @brief the opacities with which each feature of an image gets the attention that is asked for
 *
 * The output is a table with a row per feature, on the first process: feature, target, vws before and after, opacity
 * before and after. Its field data have the answer as a preset for ParaView (preset) and the length that its opacities
 * are of (opacity_unit_distance).
 */
#ifndef vtkPellucidOptimize_h
#define vtkPellucidOptimize_h

#include "PellucidParaViewFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

#include <string> // for std::string

class PELLUCIDPARAVIEWFILTERS_EXPORT vtkPellucidOptimize : public vtkTableAlgorithm {
public:
    static vtkPellucidOptimize* New();
    vtkTypeMacro(vtkPellucidOptimize, vtkTableAlgorithm);
    void PrintSelf(ostream& os, vtkIndent indent) override;

    ///@{
    /** A file (*.tf.json, *.tfi), tents:N[:PEAK], preset:NAME, or auto: what the data propose. */
    vtkSetStdStringFromCharMacro(TransferFunction);
    vtkGetCharFromStdStringMacro(TransferFunction);
    ///@}
    ///@{
    /** The share of attention that each feature should get, such as 1,2,2, or equal. */
    vtkSetStdStringFromCharMacro(Targets);
    vtkGetCharFromStdStringMacro(Targets);
    ///@}
    ///@{
    /** Where the first process writes the answer: *.tf.json, or *.paraview.json; empty: nowhere. */
    vtkSetStdStringFromCharMacro(OutputFile);
    vtkGetCharFromStdStringMacro(OutputFile);
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
    vtkPellucidOptimize();
    ~vtkPellucidOptimize() override = default;
    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
    int FillInputPortInformation(int port, vtkInformation* info) override;

private:
    vtkPellucidOptimize(const vtkPellucidOptimize&) = delete;
    void operator=(const vtkPellucidOptimize&) = delete;

    std::string TransferFunction = "auto";
    std::string Targets = "equal";
    std::string OutputFile;
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
