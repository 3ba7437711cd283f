"""Forward kinematics by hand, to check answers with: nothing of it comes from the program."""
import math

# Denavit and Hartenberg's a, d [m] and alpha [rad] of Menagerie's UR5e, tool at the flange.
UR5E = [(0, 0.163, math.pi / 2), (-0.425, 0, 0), (-0.392, 0, 0), (0, 0.134, math.pi / 2), (0, 0.1, -math.pi / 2), (0, 0.1, 0)]
UR5E_LIMITS = [2 * math.pi, 2 * math.pi, math.pi, 2 * math.pi, 2 * math.pi, 2 * math.pi]


def product(A, B):
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


def ur5e(q):
    """Pose of the tool as rows of a 4x4 matrix."""
    X = [[float(i == j) for j in range(4)] for i in range(4)]
    for angle, (a, d, alpha) in zip(q, UR5E):
        c, s, ca, sa = math.cos(angle), math.sin(angle), math.cos(alpha), math.sin(alpha)
        X = product(X, [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
    return X


def rotation(quat):
    norm = math.sqrt(sum(x * x for x in quat))
    w, x, y, z = (value / norm for value in quat)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def apart(X, pos, quat):
    """[m], [rad] How far a pose is from another."""
    R = rotation(quat)
    trace = sum(X[i][j] * R[i][j] for i in range(3) for j in range(3))
    return math.dist([X[i][3] for i in range(3)], pos), math.acos(max(-1.0, min(1.0, (trace - 1) / 2)))


def planar(q):
    """Two links of 1 m in a plane: where the second ends."""
    return [math.cos(q[0]) + math.cos(q[0] + q[1]), math.sin(q[0]) + math.sin(q[0] + q[1]), 0.0]
