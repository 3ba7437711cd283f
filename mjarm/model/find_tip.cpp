#include <algorithm>
#include <array>
#include <set>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {
namespace {

/// Names that tool frames usually bear, the likeliest first.
constexpr std::array<std::string_view, 28> kTipNames = {"hand_tcp",
                                                        "panda_hand_tcp",
                                                        "fr3_hand_tcp",
                                                        "gripper_tcp",
                                                        "tool_tcp",
                                                        "link_tcp",
                                                        "tcp",
                                                        "pinch",
                                                        "pinch_site",
                                                        "grasp_site",
                                                        "grasp",
                                                        "grasp_target",
                                                        "eef",
                                                        "panda_grasptarget",
                                                        "attachment_site",
                                                        "tool0",
                                                        "end_effector",
                                                        "ee_site",
                                                        "ee",
                                                        "ee_link",
                                                        "flange",
                                                        "panda_hand",
                                                        "fr3_hand",
                                                        "hand",
                                                        "panda_link8",
                                                        "fr3_link8",
                                                        "attachment_link",
                                                        "link_ee"};

/// Parts of names by which finger joints are known.
constexpr std::array<std::string_view, 6> kFingerWords = {"finger",  "gripper", "jaw",
                                                          "knuckle", "claw",    "grip"};

/// Fewer joints make a door or a drawer, as long as there is something longer.
constexpr std::size_t kArmJoints = 3;

/// Place in kTipNames, after a prefix that ends in '/'; the size of the list where unknown.
std::size_t tip_rank(std::string_view name) {
  if (const std::size_t slash = name.rfind('/'); slash != std::string_view::npos) {
    name.remove_prefix(slash + 1);
  }
  return static_cast<std::size_t>(std::find(kTipNames.begin(), kTipNames.end(), name) -
                                  kTipNames.begin());
}

bool has_finger_name(const mjModel* m, int joint) {
  std::string name = object_name(m, mjOBJ_JOINT, joint);
  for (char& c : name) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return std::any_of(kFingerWords.begin(), kFingerWords.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

/// Joints that an equality or a fixed tendon couples with a joint on another branch.
std::set<int> coupled_joints(const mjModel* m) {
  std::set<int> coupled;
  const auto couple = [&](int a, int b) {
    const int body_a = m->jnt_bodyid[a];
    const int body_b = m->jnt_bodyid[b];
    if (a == b || hangs_on(m, body_a, body_b) || hangs_on(m, body_b, body_a)) return;
    coupled.insert({a, b});
  };
  for (int e = 0; e < m->neq; ++e) {
    if (m->eq_type[e] != mjEQ_JOINT || m->eq_obj2id[e] < 0) continue;
    couple(m->eq_obj1id[e], m->eq_obj2id[e]);
  }
  for (int t = 0; t < m->ntendon; ++t) {
    const int begin = m->tendon_adr[t];
    const int end = begin + m->tendon_num[t];
    for (int a = begin; a < end; ++a) {
      for (int b = begin; b < a; ++b) {
        if (m->wrap_type[a] != mjWRAP_JOINT || m->wrap_type[b] != mjWRAP_JOINT) continue;
        couple(m->wrap_objid[a], m->wrap_objid[b]);
      }
    }
  }
  return coupled;
}

/// Joint chains from the world to each last joint that is no finger. Fingers are joints with such a
/// name, or coupled with a neighbour, beyond which there are only fingers; but a hinge that carries
/// two fingers or more turns them all: whatever its name, it is the wrist.
std::vector<std::vector<int>> chains_of(const mjModel* m) {
  const std::set<int> coupled = coupled_joints(m);
  std::vector<char> arm_joint(static_cast<std::size_t>(m->njnt), 0);
  std::vector<char> arm_beyond(static_cast<std::size_t>(m->nbody), 0);  ///< on bodies hung on it
  std::vector<int> fingers(static_cast<std::size_t>(m->nbody), 0);      ///< hung on it
  std::vector<int> last_bodies;
  for (int b = static_cast<int>(m->nbody) - 1; b > 0; --b) {  // children before parents
    bool beyond = arm_beyond[b] != 0;
    const bool is_last = !beyond;
    for (int j = m->body_jntadr[b] + m->body_jntnum[b] - 1; j >= m->body_jntadr[b] && j >= 0; --j) {
      if (m->jnt_type[j] != mjJNT_HINGE && m->jnt_type[j] != mjJNT_SLIDE) continue;
      const bool turns_fingers = m->jnt_type[j] == mjJNT_HINGE && fingers[b] > 1;
      const bool finger_like = coupled.count(j) > 0 || (has_finger_name(m, j) && !turns_fingers);
      if (!beyond && finger_like) {
        fingers[b] = 1;
        continue;
      }
      arm_joint[j] = 1;
      beyond = true;
    }
    if (beyond && is_last) last_bodies.push_back(b);
    if (beyond) arm_beyond[m->body_parentid[b]] = 1;
    fingers[m->body_parentid[b]] += fingers[b];
  }
  std::vector<std::vector<int>> chains;
  for (const int b : last_bodies) {
    std::vector<int> chain = joints_to(m, b);
    std::erase_if(chain, [&](int j) { return arm_joint[j] == 0; });
    chains.push_back(std::move(chain));
  }
  std::sort(chains.begin(), chains.end());
  return chains;
}

/// Chains with a common trunk longer than their branches are one arm with a many-fingered hand: the
/// trunk. Other chains stay as they are.
std::vector<std::vector<int>> join_hands(std::vector<std::vector<int>> chains) {
  std::vector<std::vector<int>> arms;
  for (std::size_t begin = 0; begin < chains.size();) {
    std::size_t end = begin;
    std::size_t trunk = chains[begin].size();
    std::size_t longest = 0;
    for (; end < chains.size() && chains[end].front() == chains[begin].front(); ++end) {
      const auto split = std::mismatch(chains[end].begin(), chains[end].end(),
                                       chains[begin].begin(), chains[begin].end());
      trunk = std::min(trunk, static_cast<std::size_t>(split.first - chains[end].begin()));
      longest = std::max(longest, chains[end].size());
    }
    if (end - begin > 1 && trunk >= 2 && trunk > longest - trunk) {
      chains[begin].resize(trunk);
      arms.push_back(chains[begin]);
    } else {
      arms.insert(arms.end(), chains.begin() + static_cast<std::ptrdiff_t>(begin),
                  chains.begin() + static_cast<std::ptrdiff_t>(end));
    }
    begin = end;
  }
  const bool has_arm = std::any_of(arms.begin(), arms.end(),
                                   [](const auto& arm) { return arm.size() >= kArmJoints; });
  if (has_arm) std::erase_if(arms, [](const auto& arm) { return arm.size() < kArmJoints; });
  return arms;
}

/// Bodies that move with `body` and nothing between: itself and its descendants without joints.
std::vector<int> rigid_group(const mjModel* m, int body) {
  std::vector<int> group = {body};
  for (int b = body + 1; b < m->nbody; ++b) {
    const bool fixed = m->body_jntnum[b] == 0 && m->body_mocapid[b] < 0;
    if (fixed && std::find(group.begin(), group.end(), m->body_parentid[b]) != group.end()) {
      group.push_back(b);
    }
  }
  return group;
}

/// Frames that can be the tool frame of an arm whose last joint moves `body`: the one with the
/// likeliest name, else its sites, else its last bodies.
std::vector<std::string> tips_of(const mjModel* m, int body) {
  const std::vector<int> group = rigid_group(m, body);
  const auto in_group = [&](int b) {
    return std::find(group.begin(), group.end(), b) != group.end();
  };
  std::vector<std::string> sites;
  for (int s = 0; s < m->nsite; ++s) {
    const char* name = mj_id2name(m, mjOBJ_SITE, s);
    if (name != nullptr && in_group(m->site_bodyid[s])) sites.emplace_back(name);
  }
  std::vector<std::string> names = sites;
  for (const int b : group) names.push_back(object_name(m, mjOBJ_BODY, b));
  const auto best = std::min_element(names.begin(), names.end(), [](const auto& a, const auto& b) {
    return tip_rank(a) < tip_rank(b);
  });
  if (tip_rank(*best) < kTipNames.size()) return {*best};
  if (!sites.empty()) return sites;

  std::vector<std::string> last;
  std::size_t depth = 0;
  for (const int b : group) {
    const std::size_t here = bodies_to(m, b).size();
    if (here > depth) last.clear();
    depth = std::max(depth, here);
    if (here == depth) last.push_back(object_name(m, mjOBJ_BODY, b));
  }
  return last;
}

}  // namespace

Result<TipFrame> find_tip(const Model& model) {
  const mjModel* m = model.raw();
  const std::vector<std::vector<int>> arms = join_hands(chains_of(m));
  const std::string file = model.file().string();
  if (arms.empty()) return fail(Errc::bad_input, text(msg::model_no_arm, file));
  std::vector<std::string> tips;
  for (const std::vector<int>& arm : arms) {
    const std::vector<std::string> some = tips_of(m, m->jnt_bodyid[arm.back()]);
    tips.insert(tips.end(), some.begin(), some.end());
  }
  if (arms.size() > 1) {
    return fail(Errc::usage, text(msg::model_many_arms, file, arms.size(), listed(tips)));
  }
  if (tips.size() > 1) return fail(Errc::usage, text(msg::model_many_tips, file, listed(tips)));
  return find_frame(model, tips.front());
}

}  // namespace mjarm
