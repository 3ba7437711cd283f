#include "apps/mjarm/cli/orientation.hpp"

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {

Result<Eigen::Matrix3d> parse_rotation(const std::string& euler, const std::string& quat) {
  if (euler.empty() == quat.empty()) {
    return fail(Errc::usage, text(msg::app_need_one_of, "--euler", "--quat"));
  }
  if (!euler.empty()) {
    const auto angles = parse_list("--euler", euler, Quantity::angle, 3);
    if (!angles) return fail(angles.error());
    return from_euler({(*angles)[0], (*angles)[1], (*angles)[2]});
  }
  const auto wxyz = parse_list("--quat", quat, Quantity::number, 4);
  if (!wxyz) return fail(wxyz.error());
  Result<Eigen::Matrix3d> R = rotation_of_quat(*wxyz);
  if (!R) return fail(in_option("--quat", R.error()));
  return R;
}

Result<IkTask> parse_task(const std::string& word) {
  const auto names = ik_task_names();
  const Result<std::size_t> choice =
      parse_choice("--task", word, std::vector<std::string>(names.begin(), names.end()));
  if (!choice) return fail(choice.error());
  return static_cast<IkTask>(*choice);
}

}  // namespace mjarm::app
