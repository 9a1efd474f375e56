// What the window shows: one volume, its transfer function with undo, the camera, the targets, the figures.
#pragma once

#include <memory>
#include <optional>

#include <QObject>
#include <QString>
#include <QUndoStack>

#include "optimize/measure.h"
#include "optimize/optimizer.h"
#include "render/camera.h"
#include "tf/transfer_function.h"
#include "volume/histogram.h"
#include "volume/loader.h"

namespace pellucid::gui {

/// A volume ready to be shown: all that takes time to make from it, made off the window's thread.
struct LoadedVolume {
    VolumeSource source;
    std::shared_ptr<const Volume> volume;
    Histogram histogram;        ///< 256 bins
    TransferFunction defaultTf; ///< what the volume opens with
};

/// Lives in the window's thread. Every lasting change of the transfer function is one entry of the undo stack; a
/// preview (while the mouse is down, while an optimization runs) is not, and ends with commitPreview() or
/// cancelPreview().
class Document : public QObject {
    Q_OBJECT
public:
    explicit Document(QObject* parent = nullptr);

    bool hasVolume() const { return m_loaded.volume != nullptr; }
    const std::shared_ptr<const Volume>& volume() const { return m_loaded.volume; }
    const LoadedVolume& loaded() const { return m_loaded; }
    const Histogram& histogram() const { return m_loaded.histogram; }
    const TransferFunction& tf() const { return m_tf; }
    const Camera& camera() const { return m_camera; }
    QUndoStack& undoStack() { return m_undo; }

    /// Counts every change of volume, transfer function or camera: tells whether figures are of the present state.
    quint64 version() const { return m_version; }

    /// Replaces the volume; the transfer function becomes `tf` or the volume's default, the undo history is emptied.
    void setVolume(LoadedVolume loaded, const TransferFunction* tf = nullptr);
    void setCamera(const Camera& camera);

    /// One undo step named `text`. Steps with the same non-empty `mergeKey` in a row become one. No change, no step.
    void setTf(const TransferFunction& tf, const QString& text, const QString& mergeKey = {});
    /// Shows `tf` without an undo step.
    void previewTf(const TransferFunction& tf);
    bool isPreviewing() const { return m_beforePreview.has_value(); }
    /// The transfer function before the preview began; tf() where none is under way.
    const TransferFunction& committedTf() const { return m_beforePreview ? *m_beforePreview : m_tf; }
    void commitPreview(const QString& text, const QString& mergeKey = {});
    void cancelPreview();

    /// One target per feature, sum 1.
    const std::vector<double>& targets() const { return m_targets; }
    /// Sets one target to `value` in [0,1]; the others share the rest in their old proportion.
    void setTarget(int feature, double value);
    /// Normalised to sum 1; as many as features.
    void setTargets(std::vector<double> targets);

    /// The latest figures; those of an older state until new ones come. Empty before the first.
    const std::optional<Measures>& measures() const { return m_measures; }
    bool measuresAreCurrent() const { return m_measures && m_measuresVersion == m_version; }
    void setMeasures(const Measures& measures, quint64 version);
    /// Shares of an optimization's latest move, for the bars.
    void setVws(const std::vector<double>& vws);

    /// The latest ∂W_i/∂x_j as [i][j]; those of an older state until new ones come. Empty where nobody wants them.
    const std::optional<std::vector<std::vector<double>>>& influence() const { return m_influence; }
    bool influenceIsCurrent() const { return m_influence && m_influenceVersion == m_version; }
    void setInfluence(std::vector<std::vector<double>> influence, quint64 version);

    QString title() const;

Q_SIGNALS:
    void volumeChanged();
    void tfChanged();
    void featuresChanged(); ///< their number, names, ranges or colours
    void cameraChanged();
    void targetsChanged();
    void measuresChanged();
    void influenceChanged();

private:
    friend class TfCommand;
    void applyTf(const TransferFunction& tf);

    LoadedVolume m_loaded;
    TransferFunction m_tf;
    std::optional<TransferFunction> m_beforePreview;
    Camera m_camera;
    std::vector<double> m_targets;
    std::optional<Measures> m_measures;
    std::optional<std::vector<std::vector<double>>> m_influence;
    quint64 m_version = 0, m_measuresVersion = 0, m_influenceVersion = 0;
    QUndoStack m_undo;
};

} // namespace pellucid::gui
