"""Makes the policies of stable-baselines3 that sb3_zip_test reads, and what they answer.

    python make_sb3.py        with stable-baselines3 2.9.2; writes beside this script

sb3_tanh.zip    as saved by default: the activation is not named
sb3_relu.zip    ReLU, an actor and a critic of different depth
sb3_shared.zip  layers that actor and critic share, in the names of stable-baselines3 1.x
sb3_flat.zip    no hidden layer
sb3_sde.zip     state-dependent exploration, which is refused
sb3_guide.zip   the sizes of the tutorial's task: ten observations, seven actions
sb3_actions.json  observations and the actions of stable-baselines3 itself
"""

import io
import json
import pathlib
import zipfile

import gymnasium
import numpy
import stable_baselines3
import stable_baselines3.common.base_class as base_class
import torch

HERE = pathlib.Path(__file__).parent
LOW = numpy.array([-0.6, -2.0], numpy.float32)
HIGH = numpy.array([0.7, 0.5], numpy.float32)


class Still(gymnasium.Env):
    """A task in which nothing happens."""

    def __init__(self, observations, low, high):
        self.observation_space = gymnasium.spaces.Box(-numpy.inf, numpy.inf, (observations,), numpy.float32)
        self.action_space = gymnasium.spaces.Box(low, high)

    def reset(self, seed=None, options=None):
        return numpy.zeros(self.observation_space.shape, numpy.float32), {}

    def step(self, action):
        return numpy.zeros(self.observation_space.shape, numpy.float32), 0.0, False, False, {}


def policy(seed, task=None, **arguments):
    model = stable_baselines3.PPO(
        "MlpPolicy", task or Still(5, LOW, HIGH), seed=seed, n_steps=8, batch_size=8, device="cpu", **arguments)
    with torch.no_grad():
        for parameter in model.policy.parameters():
            parameter.add_(0.4 * torch.randn_like(parameter))
    return model


OLD_NAMES = {"policy_net.0": "shared_net.0", "policy_net.2": "policy_net.0",
             "value_net.0": None, "value_net.2": "value_net.0"}


def in_old_names(path):
    """Rewrites a policy as version 1.x saved one whose actor and critic share the first layer."""
    with zipfile.ZipFile(path) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    state = torch.load(io.BytesIO(entries["policy.pth"]), weights_only=True)
    renamed = type(state)()
    for name, tensor in state.items():
        if name.startswith("mlp_extractor."):
            _, net, index, part = name.split(".")
            layer = OLD_NAMES[f"{net}.{index}"]
            if layer is None:
                continue
            name = f"mlp_extractor.{layer}.{part}"
        renamed[name] = tensor
    saved = io.BytesIO()
    torch.save(renamed, saved)
    entries["policy.pth"] = saved.getvalue()
    entries["_stable_baselines3_version"] = b"1.8.0"
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)


def main():
    # Nothing about the machine that ran this.
    base_class.save_to_zip_file.__globals__["get_system_info"] = lambda print_info: ({}, "")
    observations = numpy.random.default_rng(3).normal(0, 1.5, (20, 5)).astype(numpy.float32)
    models = {
        "sb3_tanh": policy(1, policy_kwargs={"net_arch": [8, 8]}),
        "sb3_relu": policy(2, policy_kwargs={"net_arch": {"pi": [8, 6, 4], "vf": [7]},
                                             "activation_fn": torch.nn.ReLU}),
        "sb3_shared": policy(3, policy_kwargs={"net_arch": [6, 5]}),
        "sb3_flat": policy(4, policy_kwargs={"net_arch": []}),
        "sb3_guide": policy(6, Still(10, -numpy.ones(7, numpy.float32), numpy.ones(7, numpy.float32)),
                            policy_kwargs={"net_arch": [4]}),
        "sb3_sde": policy(5, policy_kwargs={"net_arch": [4]}, use_sde=True),
    }
    truth = {"low": LOW.tolist(), "high": HIGH.tolist(), "observations": observations.tolist()}
    models.pop("sb3_guide").save(HERE / "sb3_guide.zip")
    for name, model in models.items():
        actions, _ = model.predict(observations, deterministic=True)
        values = model.policy.predict_values(torch.from_numpy(observations)).detach().numpy()
        truth[name] = {"actions": actions.tolist(), "values": values[:, 0].tolist()}
        model.save(HERE / f"{name}.zip")
    in_old_names(HERE / "sb3_shared.zip")
    # The critic got the actor's first layer: what it answers now is not known to the library.
    del truth["sb3_shared"]["values"]
    (HERE / "sb3_actions.json").write_text(json.dumps(truth) + "\n")


main()
