#include "models/document.h"

#include <algorithm>
#include <numeric>

#include "render/camera_motion.h"
#include "models/tf_command.h"

namespace pellucid::gui {

bool TfCommand::mergeWith(const QUndoCommand* other) {
    const auto* next = dynamic_cast<const TfCommand*>(other);
    if (next == nullptr || next->m_mergeKey != m_mergeKey) return false;
    m_after = next->m_after;
    setObsolete(m_after == m_before);
    return true;
}

Document::Document(QObject* parent) : QObject(parent) { m_undo.setUndoLimit(500); }

void Document::setVolume(LoadedVolume loaded, const TransferFunction* tf) {
    const Projection projection = m_camera.projection;
    m_loaded = std::move(loaded);
    m_beforePreview.reset();
    m_undo.clear();
    m_measures.reset();
    m_influence.reset();
    m_camera = homeCamera(m_loaded.volume->geometry(), projection);
    m_targets.clear();
    ++m_version;
    Q_EMIT volumeChanged();
    Q_EMIT cameraChanged();
    applyTf(tf != nullptr ? *tf : m_loaded.defaultTf);
    Q_EMIT measuresChanged();
}

void Document::setCamera(const Camera& camera) {
    if (camera == m_camera) return;
    m_camera = camera;
    ++m_version;
    Q_EMIT cameraChanged();
}

void Document::setTf(const TransferFunction& tf, const QString& text, const QString& mergeKey) {
    previewTf(tf);
    commitPreview(text, mergeKey);
}

void Document::previewTf(const TransferFunction& tf) {
    if (!m_beforePreview) m_beforePreview = m_tf;
    applyTf(tf);
}

void Document::commitPreview(const QString& text, const QString& mergeKey) {
    if (!m_beforePreview) return;
    TransferFunction before = std::move(*m_beforePreview);
    m_beforePreview.reset();
    if (before == m_tf) return;
    m_undo.push(new TfCommand(*this, std::move(before), m_tf, text, mergeKey));
}

void Document::cancelPreview() {
    if (!m_beforePreview) return;
    const TransferFunction before = std::move(*m_beforePreview);
    m_beforePreview.reset();
    applyTf(before);
}

void Document::applyTf(const TransferFunction& tf) {
    const bool sameFeatures = tf.features == m_tf.features && m_targets.size() == tf.features.size();
    const bool changed = !(tf == m_tf);
    const bool sameNames =
        std::equal(m_tf.features.begin(), m_tf.features.end(), tf.features.begin(), tf.features.end(),
                   [](const Feature& a, const Feature& b) { return a.name == b.name; });
    m_tf = tf;
    if (changed) ++m_version;
    if (!sameFeatures) {
        if (!sameNames) m_influence.reset(); // it would stand under other names
        if (m_targets.size() != m_tf.features.size()) {
            const std::size_t n = m_tf.features.size();
            m_targets.assign(n, n == 0 ? 0.0 : 1.0 / static_cast<double>(n));
            m_measures.reset();
        }
        Q_EMIT featuresChanged();
        Q_EMIT targetsChanged();
    }
    if (changed) Q_EMIT tfChanged();
}

void Document::setTarget(int feature, double value) {
    const auto f = static_cast<std::size_t>(feature);
    if (feature < 0 || f >= m_targets.size()) return;
    if (m_targets.size() == 1) return; // one feature has it all
    value = std::clamp(value, 0.0, 1.0);
    std::vector<double> targets = m_targets;
    const double others = std::accumulate(targets.begin(), targets.end(), 0.0) - targets[f];
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (i == f) continue;
        targets[i] = others > 1e-9 ? targets[i] / others * (1.0 - value)
                                   : (1.0 - value) / static_cast<double>(targets.size() - 1);
    }
    targets[f] = value;
    if (targets == m_targets) return;
    m_targets = std::move(targets);
    Q_EMIT targetsChanged();
}

void Document::setTargets(std::vector<double> targets) {
    m_targets = normalizedTargets(std::move(targets), m_tf.features.size());
    Q_EMIT targetsChanged();
}

void Document::setMeasures(const Measures& measures, quint64 version) {
    if (measures.features.size() != m_tf.features.size()) return; // of another transfer function
    m_measures = measures;
    m_measuresVersion = version;
    Q_EMIT measuresChanged();
}

void Document::setInfluence(std::vector<std::vector<double>> influence, quint64 version) {
    if (influence.size() != m_tf.features.size()) return; // of another transfer function
    m_influence = std::move(influence);
    m_influenceVersion = version;
    Q_EMIT influenceChanged();
}

void Document::setVws(const std::vector<double>& vws) {
    if (!m_measures || m_measures->features.size() != vws.size()) return;
    for (std::size_t i = 0; i < vws.size(); ++i) m_measures->features[i].vws = vws[i];
    Q_EMIT measuresChanged();
}

QString Document::title() const { return hasVolume() ? QString::fromStdString(m_loaded.volume->title) : QString(); }

} // namespace pellucid::gui
