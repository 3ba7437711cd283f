"""The arm and the obstacles of a planning problem as MuJoCo sees them, for peers that have no collision checker.

The file of problems (as `mjarm plan` reads it) gives the robot as a tree of joints with spheres, and which pairs of
links must not overlap. Exactly these pairs and every sphere against every obstacle are looked at, by contact bits.
"""


def words(values):
    return " ".join(repr(float(v)) for v in values)


def link_bits(robot):
    """Contact bits of each link with spheres: its own, and those of links it must not overlap; bit 0: obstacles."""
    links = list(dict.fromkeys(sphere["link"] for sphere in robot["spheres"]))
    if len(links) > 30:
        raise NotImplementedError("more links with spheres than contact bits")
    own = {link: 1 << (i + 1) for i, link in enumerate(links)}
    against = {link: 1 for link in links}
    for a, b in robot["self_collision_link_pairs"]:
        against[a] |= own[b]
    return own, against


def link_text(robot, link, bits):
    """The spheres of a link, its joints' children inside of it."""
    own, against = bits
    text = ""
    for sphere in robot["spheres"]:
        if sphere["link"] == link:
            text += f'<geom size="{float(sphere["radius"])!r}" pos="{words(sphere["center"])}" '
            text += f'contype="{own[link]}" conaffinity="{against[link]}"/>'
    for joint in robot["joints"]:
        if joint["parent"] != link:
            continue
        text += f'<body pos="{words(joint["xyz"])}" quat="{words(joint["quat"])}">'
        if joint["name"] in robot["joint_names"]:
            kind = "slide" if joint["type"] == "prismatic" else "hinge"
            text += f'<joint name="{joint["name"]}" type="{kind}" axis="{words(joint["axis"])}"/>'
            text += '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        text += link_text(robot, joint["child"], bits) + "</body>"
    return text


def obstacle_text(obstacle):
    """Cylinders as the problem's reference replaces them."""
    kind, place = obstacle["type"], f'pos="{words(obstacle["pos"])}" contype="1" conaffinity="0"'
    if kind == "sphere":
        return f'<geom type="sphere" size="{float(obstacle["radius"])!r}" {place}/>'
    place += f' quat="{words(obstacle["quat"])}"'
    if kind == "box":
        return f'<geom type="box" size="{words(obstacle["half"])}" {place}/>'
    radius, half = obstacle["radius"], obstacle["length"] / 2
    kind = obstacle.get("vamp_as", "cylinder")
    size = words([radius, radius, half] if kind == "box" else [radius, half])
    return f'<geom type="{kind}" size="{size}" {place}/>'


def mjcf(robot, obstacles):
    return (
        '<mujoco><compiler angle="radian"/><option><flag filterparent="disable"/></option><worldbody>'
        + "".join(obstacle_text(obstacle) for obstacle in obstacles)
        # A body of its own: what stands still together is not looked at.
        + f'<body>{link_text(robot, robot["base"], link_bits(robot))}</body></worldbody></mujoco>'
    )


def checker(robot, obstacles):
    """A function: joint values -> whether nothing touches."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(mjcf(robot, obstacles))
    data = mujoco.MjData(model)
    names = [model.joint(i).name for i in range(model.njnt)]
    at = [names.index(name) for name in robot["joint_names"]]
    qpos = data.qpos
    kinematics, collision = mujoco.mj_kinematics, mujoco.mj_collision
    in_order = at == list(range(len(at)))

    def is_free(q):
        if in_order:
            qpos[:] = q
        else:
            qpos[at] = q
        kinematics(model, data)
        collision(model, data)
        return data.ncon == 0

    return is_free
