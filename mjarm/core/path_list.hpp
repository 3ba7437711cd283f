#pragma once

namespace mjarm {

/// What stands between the folders of a list in an environment variable, such as ROS_PACKAGE_PATH.
#if defined(_WIN32)
inline constexpr char kPathListSeparator = ';';
#else
inline constexpr char kPathListSeparator = ':';
#endif

}  // namespace mjarm
