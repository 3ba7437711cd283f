#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm::app {

/// Forward kinematics by MuJoCo itself: shares no code with what is tested.
class Oracle {
 public:
  /// @param site  the tool; its pose is wanted.
  Oracle(const std::string& file, const std::string& site) {
    char error[500] = "";
    model_.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
    if (!model_) throw std::runtime_error(file + ": " + error);
    data_.reset(mj_makeData(model_.get()));
    site_ = mj_name2id(model_.get(), mjOBJ_SITE, site.c_str());
    if (site_ < 0) throw std::runtime_error(file + ": no site " + site);
  }

  /// The arm's joints are the first of the model; the others stay at 0.
  Pose fk(const std::vector<double>& q) {
    mju_zero(data_->qpos, static_cast<int>(model_->nq));
    mju_copy(data_->qpos, q.data(), static_cast<int>(q.size()));
    mj_kinematics(model_.get(), data_.get());
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    return {Eigen::Vector3d(data_->site_xpos + 3 * site_),
            Eigen::Map<const RowMajor>(data_->site_xmat + 9 * site_)};
  }

  /// True where every value is within the range of its joint.
  [[nodiscard]] bool within_limits(const std::vector<double>& q) const {
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (q[i] < model_->jnt_range[2 * i] || q[i] > model_->jnt_range[2 * i + 1]) return false;
    }
    return true;
  }

 private:
  struct Deleter {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Deleter> model_;
  std::unique_ptr<mjData, Deleter> data_;
  int site_ = -1;
};

}  // namespace mjarm::app
