#pragma once

#include <string>

namespace spume::apps {

/// Joins the pictures `pictures`.*.png, in the order of their names, to the movie `path` with ffmpeg.
/// Returns an empty string, or why there is no movie; ffmpeg is never required.
std::string writeMovie(const std::string& pictures, double fps, const std::string& path);

}  // namespace spume::apps
