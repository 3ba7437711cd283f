#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace mjarm {

/// A mesh in MuJoCo's tables.
struct MeshTable {
  MeshTable(const mjModel& m, int mesh)
      : vertex_count(m.mesh_vertnum[mesh]),
        face_count(m.mesh_facenum[mesh]),
        vertices(m.mesh_vert + 3 * static_cast<std::ptrdiff_t>(m.mesh_vertadr[mesh])),
        faces(m.mesh_face + 3 * static_cast<std::ptrdiff_t>(m.mesh_faceadr[mesh])) {}

  [[nodiscard]] Eigen::Vector3d vertex(int i) const {
    return Eigen::Map<const Eigen::Vector3f>(vertices + 3 * i).cast<double>();
  }
  /// Its corners, as numbers of vertices.
  [[nodiscard]] std::array<int, 3> face(int i) const {
    return {faces[3 * i], faces[3 * i + 1], faces[3 * i + 2]};
  }

  int vertex_count, face_count;
  const float* vertices;  ///< [m] shape (3 vertex_count,)
  const int* faces;       ///< shape (3 face_count,)
};

}  // namespace mjarm
