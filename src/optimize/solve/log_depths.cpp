#include "optimize/solve/log_depths.h"

#include <algorithm>
#include <cmath>

#include "tf/opacity.h"

namespace pellucid {

namespace {

double inPlace(double opacity) { return std::clamp(opacity, kLeastOpacity, kMostOpacity); }

} // namespace

double logDepthOf(double opacity) { return std::log(opticalDepthOfOpacity(inPlace(opacity))); }
double opacityOfLogDepth(double y) { return -std::expm1(-std::exp(y)); }

LogDepths::LogDepths(std::vector<OpacityLimits> limits, const std::vector<double>& wanted, Log log)
    : m_limits(std::move(limits)), m_log(log) {
    m_limits.resize(wanted.size());
    for (std::size_t f = 0; f < wanted.size(); ++f)
        if (wanted[f] > 0 && !m_limits[f].locked && m_limits[f].lowest < m_limits[f].highest) m_features.push_back(f);
    m_lowest.resize(m_features.size());
    m_highest.resize(m_features.size());
    for (std::size_t i = 0; i < m_features.size(); ++i) {
        m_lowest[i] = yOf(m_limits[m_features[i]].lowest);
        m_highest[i] = yOf(m_limits[m_features[i]].highest);
    }
}

double LogDepths::yOf(double opacity) const {
    return m_log == Log::Depth ? logDepthOf(opacity) : std::log(std::max(opacity, kLeastOpacity));
}

Vector LogDepths::from(const std::vector<double>& opacity) const {
    Vector y(count());
    for (std::size_t i = 0; i < m_features.size(); ++i) y[i] = yOf(opacity[m_features[i]]);
    return clamped(y);
}

std::vector<double> LogDepths::opacities(const Vector& y, std::vector<double> opacity) const {
    const Vector there = from(opacity);
    for (std::size_t i = 0; i < m_features.size(); ++i) {
        if (y[i] == there[i]) continue;
        const OpacityLimits& limit = m_limits[m_features[i]];
        const double x = m_log == Log::Depth ? opacityOfLogDepth(y[i]) : std::exp(y[i]);
        opacity[m_features[i]] = std::clamp(x, limit.lowest, limit.highest);
    }
    return opacity;
}

LogDepths::Steps LogDepths::stepsFrom(const Vector& y, double reach) const {
    return {(m_lowest - y).cwiseMax(-reach).cwiseMin(0.0), (m_highest - y).cwiseMin(reach).cwiseMax(0.0)};
}

Vector LogDepths::slopes(const std::vector<double>& opacity) const {
    Vector slopes(count());
    for (std::size_t i = 0; i < m_features.size(); ++i) {
        const double x = inPlace(opacity[m_features[i]]);
        slopes[i] = m_log == Log::Depth ? (1 - x) * opticalDepthOfOpacity(x) : x;
    }
    return slopes;
}

Matrix LogDepths::derivatives(const Matrix& byOpacity, const std::vector<double>& opacity) const {
    return byOpacity(Eigen::all, m_features) * slopes(opacity).asDiagonal();
}

std::vector<double> LogDepths::capped(std::vector<double> opacity) const {
    for (const std::size_t f : m_features) opacity[f] = std::min(opacity[f], kMostOpacity);
    return opacity;
}

std::vector<double> LogDepths::inside(const std::vector<double>& opacity) const {
    double sum = 0;
    int above = 0;
    for (const std::size_t f : m_features)
        if (opacity[f] > 0) {
            sum += std::log(opacity[f]);
            ++above;
        }
    const double usual = above > 0 ? std::clamp(std::exp(sum / above), 1e-3, 0.5) : 0.1;
    std::vector<double> x = opacity;
    for (std::size_t f = 0; f < x.size(); ++f)
        if (!m_limits[f].locked) x[f] = m_limits[f].lowest;
    for (const std::size_t f : m_features) x[f] = opacity[f] < kLeastOpacity ? usual : opacity[f];
    return within(m_limits, std::move(x));
}

} // namespace pellucid
