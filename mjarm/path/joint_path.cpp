#include "mjarm/path/joint_path.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/path.hpp"

namespace mjarm {

double JointPath::max_step() const {
  double worst = 0;
  for (std::size_t i = 1; i < q.size(); ++i) {
    worst = std::max(worst, (q[i] - q[i - 1]).cwiseAbs().maxCoeff());
  }
  return worst;
}

Result<JointPath> joint_line(std::span<const double> q0, std::span<const double> q1, int n) {
  if (n < 2 || q0.empty() || q0.size() != q1.size() ||
      q0.size() > static_cast<std::size_t>(kMaxDof) || !all_finite(q0) || !all_finite(q1)) {
    return fail(Errc::bad_input, text(msg::path_bad_call));
  }
  const JointVec from = joint_vec(q0), to = joint_vec(q1);
  const double length = (to - from).norm();
  JointPath path;
  for (int i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / (n - 1);
    path.s.push_back(t * length);
    path.q.push_back((1 - t) * from + t * to);
  }
  return path;
}

}  // namespace mjarm
