#include "apps/preview/camera.h"

#include <algorithm>
#include <cmath>

namespace spume::apps {

Camera::Camera(const coupling::CameraSpec& spec, const Eigen::AlignedBox3f& shown, int width, int height)
    : eye_(spec.eye.cast<float>()),
      target_(spec.target.cast<float>()),
      tangent_(static_cast<float>(std::tan(0.5 * spec.fieldOfView * M_PI / 180))),
      width_(static_cast<float>(width)),
      height_(static_cast<float>(height)) {
  const bool automatic = spec.eye == spec.target;
  const Vec3 fromFront = Vec3(-0.45f, 0.26f, 1.0f).normalized();
  forward_ = automatic ? Vec3(-fromFront) : (target_ - eye_).normalized();
  const Vec3 upright = std::abs(forward_.y()) > 0.999f ? Vec3::UnitZ() : Vec3::UnitY();
  right_ = forward_.cross(upright).normalized();
  up_ = right_.cross(forward_);
  if (automatic) placeBefore(shown, width_ / height_);
}

/// Moves back and sideways until every corner of the box is in the picture, centred and with a margin.
void Camera::placeBefore(const Eigen::AlignedBox3f& shown, float aspect) {
  constexpr float kMargin = 0.92f;
  constexpr int kRounds = 8;  // each round shrinks the error of the centring about tenfold
  const Vec3 lower = shown.min(), upper = shown.max();
  target_ = 0.5f * (lower + upper);
  float distance = 2 * (upper - lower).norm();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Array2f least = Eigen::Array2f::Constant(1e9f), most = -least;
    for (int c = 0; c < 8; ++c) {
      const Vec3 corner((c & 1 ? upper : lower).x(), (c & 2 ? upper : lower).y(),
                        (c & 4 ? upper : lower).z());
      const Vec3 offset = corner - target_;
      const Eigen::Array2f seen(offset.dot(right_) / aspect, offset.dot(up_));
      least = least.min(seen / (distance + offset.dot(forward_)));
      most = most.max(seen / (distance + offset.dot(forward_)));
    }
    const Eigen::Array2f middle = 0.5f * distance * (least + most);
    target_ += middle.x() * aspect * right_ + middle.y() * up_;
    distance *= 0.5f * (most - least).maxCoeff() / (kMargin * tangent_);
  }
  eye_ = target_ - distance * forward_;
}

Vec3 Camera::direction(float x, float y) const {
  const float h = (2 * x / width_ - 1) * tangent_ * width_ / height_;
  const float v = (1 - 2 * y / height_) * tangent_;
  return (forward_ + h * right_ + v * up_).normalized();
}

}  // namespace spume::apps
