#pragma once

#include <cstdint>
#include <vector>

#include "apps/bench/ik.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// 300 poses each that an arm reaches where solvers tend to lose it: one, two and three joints at a
/// limit; three a milliradian (or millimetre) inside; about half of all joints at zero, where arms
/// are stretched; every joint at a limit or zero. The other joints are random, and so is where the
/// search starts. The poses are those of MuJoCo's own forward kinematics. Joints without stops
/// have no limit to stand at.
[[nodiscard]] Result<std::vector<IkCaseSet>> make_hard_sets(const Robot& robot, std::uint64_t seed);

/// `mjarm bench ik --hard`: how many of these are refused or answered wrongly, and why.
[[nodiscard]] BenchVariant ik_hard_variant();

}  // namespace mjarm::app
