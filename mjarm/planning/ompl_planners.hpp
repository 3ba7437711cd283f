#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mjarm {

/// Names for PlanOptions::ompl_planner, the same in every build: those geometric planners of the
/// Open Motion Planning Library (I. A. Sucan, M. Moll and L. E. Kavraki, IEEE Robotics & Automation
/// Magazine 19 (2012) 72) whose answer depends on the problem and the seed alone. RRTstar,
/// RRTsharp, InformedRRTstar, BITstar and ABITstar go on after their first path; the others return
/// it.
/// The first search turns off the messages of OMPL in the whole process.
[[nodiscard]] std::span<const std::string> ompl_planner_names();

/// The version of OMPL that this build was compiled with, as "1.5.2"; empty where it has none, so
/// that Planner::ompl fails with PlanErrc::not_available.
[[nodiscard]] std::string_view ompl_version() noexcept;

}  // namespace mjarm
