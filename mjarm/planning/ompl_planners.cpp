#include "mjarm/planning/ompl_planners.hpp"

#include <vector>

#ifdef MJARM_OMPL
#include <ompl/config.h>
#endif

namespace mjarm {

std::span<const std::string> ompl_planner_names() {
  static const std::vector<std::string> kNames{"RRTConnect",      "RRT",     "LazyRRT", "EST",
                                               "BiEST",           "FMT",     "RRTstar", "RRTsharp",
                                               "InformedRRTstar", "BITstar", "ABITstar"};
  return kNames;
}

std::string_view ompl_version() noexcept {
#ifdef MJARM_OMPL
#define MJARM_AS_TEXT(x) #x
#define MJARM_VERSION_TEXT(a, b, c) MJARM_AS_TEXT(a) "." MJARM_AS_TEXT(b) "." MJARM_AS_TEXT(c)
  return MJARM_VERSION_TEXT(OMPL_MAJOR_VERSION, OMPL_MINOR_VERSION, OMPL_PATCH_VERSION);
#undef MJARM_VERSION_TEXT
#undef MJARM_AS_TEXT
#else
  return {};
#endif
}

}  // namespace mjarm
