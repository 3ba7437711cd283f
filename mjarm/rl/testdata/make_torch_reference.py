"""Makes torch_reference.json: PPO's numbers as torch and stable-baselines3 compute them.

Usage: make_torch_reference.py > torch_reference.json
Made with torch 2.15.0 and stable-baselines3 2.9.2. Parameters are flat in the order of Policy:
weight and bias of the actor's layers, of the critic's, log_std.
"""

import json

import numpy as np
import torch
from gymnasium import spaces
from stable_baselines3.common.buffers import RolloutBuffer

OBSERVATIONS, ACTIONS, ACTOR, CRITIC, SAMPLES = 5, 3, [9, 6], [7], 12
RATE, EPSILON, MAX_NORM, STEPS = 3e-3, 1e-5, 0.5, 3

CASES = {
    "plain": dict(activation="tanh", clip=0.2, value_clip=0.0, value_weight=0.5,
                  entropy_weight=0.0, normalise=True),
    "all_terms": dict(activation="tanh", clip=0.1, value_clip=0.3, value_weight=0.7,
                      entropy_weight=0.01, normalise=False),
    "relu": dict(activation="relu", clip=0.3, value_clip=0.0, value_weight=1.0,
                 entropy_weight=0.002, normalise=True),
}


def numbers(array):
    return [float(f"{x:.9g}") for x in np.asarray(array, dtype=float).ravel()]


def draw(rng, *shape):
    """Normal numbers that float32 holds exactly."""
    return torch.tensor(rng.normal(size=shape).astype(np.float32).astype(np.float64))


def make_net(rng, hidden, outputs, activation):
    layers, inputs = [], OBSERVATIONS
    for size in [*hidden, outputs]:
        linear = torch.nn.Linear(inputs, size, dtype=torch.float64)
        linear.weight.data = draw(rng, size, inputs) * 0.5
        linear.bias.data = draw(rng, size) * 0.25
        layers += [linear, torch.nn.Tanh() if activation == "tanh" else torch.nn.ReLU()]
        inputs = size
    return torch.nn.Sequential(*layers[:-1])


def losses(actor, critic, log_std, data, o):
    normal = torch.distributions.Normal(actor(data["observations"]), log_std.exp())
    log_prob = normal.log_prob(data["actions"]).sum(dim=1)
    advantages = data["advantages"]
    if o["normalise"]:
        advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
    log_ratio = log_prob - data["log_probs"]
    ratio = log_ratio.exp()
    clamped = ratio.clamp(1 - o["clip"], 1 + o["clip"])
    policy = -torch.min(advantages * ratio, advantages * clamped).mean()
    values = critic(data["observations"]).flatten()
    if o["value_clip"] > 0:
        change = (values - data["values"]).clamp(-o["value_clip"], o["value_clip"])
        values = data["values"] + change
    value = torch.nn.functional.mse_loss(data["returns"], values)
    entropy = normal.entropy().sum(dim=1).mean()
    total = policy + o["value_weight"] * value - o["entropy_weight"] * entropy
    report = dict(policy=policy.item(), value=value.item(), entropy=entropy.item(),
                  kl=((ratio - 1) - log_ratio).mean().item(),
                  clip_fraction=((ratio - 1).abs() > o["clip"]).double().mean().item())
    return total, report


def make_case(name, o, rng):
    actor = make_net(rng, ACTOR, ACTIONS, o["activation"])
    critic = make_net(rng, CRITIC, 1, o["activation"])
    log_std = torch.nn.Parameter(draw(rng, ACTIONS) * 0.25)
    parameters = [*actor.parameters(), *critic.parameters(), log_std]
    flat = lambda: numbers(torch.cat([p.detach().flatten() for p in parameters]))
    data = {key: draw(rng, SAMPLES) for key in ("advantages", "returns", "values")}
    data["observations"] = draw(rng, SAMPLES, OBSERVATIONS)
    data["actions"] = draw(rng, SAMPLES, ACTIONS)
    with torch.no_grad():
        means, values = actor(data["observations"]), critic(data["observations"])
        old = torch.distributions.Normal(means, log_std.exp()).log_prob(data["actions"]).sum(dim=1)
        data["log_probs"] = (old + 0.2 * draw(rng, SAMPLES)).float().double()
        data["values"] = (values.flatten() + 0.4 * data["values"]).float().double()
    out = dict(name=name, options=o, start=flat(), means=numbers(means), critic=numbers(values),
               data={key: numbers(value) for key, value in data.items()})
    optimizer = torch.optim.Adam(parameters, lr=RATE, eps=EPSILON)
    for step in range(STEPS):
        total, report = losses(actor, critic, log_std, data, o)
        optimizer.zero_grad()
        total.backward()
        if step == 0:
            out["losses"] = report
            out["gradient"] = numbers(torch.cat([p.grad.flatten() for p in parameters]))
        torch.nn.utils.clip_grad_norm_(parameters, MAX_NORM)
        optimizer.step()
    out["after_adam"] = flat()
    return out


def make_gae(rng):
    """What stable-baselines3 makes of episodes that end, are cut, or go on."""
    steps, copies, discount, gae_lambda = 15, 4, 0.97, 0.9
    f32 = lambda *shape: rng.normal(size=shape).astype(np.float32)
    rewards, values, final_values, last_values = (f32(steps, copies), f32(steps, copies),
                                                  f32(steps, copies), f32(copies))
    ends = rng.random((steps, copies))
    terminated, truncated = ends < 0.15, (ends >= 0.15) & (ends < 0.35)
    done = terminated | truncated
    space = spaces.Box(-1, 1, (1,))
    buffer = RolloutBuffer(steps, space, space, "cpu", gae_lambda, discount, copies)
    for t in range(steps):
        starts = done[t - 1] if t > 0 else np.zeros(copies)
        given = rewards[t] + discount * final_values[t] * truncated[t]
        buffer.add(np.zeros((copies, 1)), np.zeros((copies, 1)), given, starts,
                   torch.tensor(values[t]), torch.zeros(copies))
    buffer.compute_returns_and_advantage(torch.tensor(last_values), done[-1])
    return dict(copies=copies, discount=discount, gae_lambda=gae_lambda, rewards=numbers(rewards),
                values=numbers(values), final_values=numbers(final_values),
                last_values=numbers(last_values), terminated=numbers(terminated),
                truncated=numbers(truncated), advantages=numbers(buffer.advantages),
                returns=numbers(buffer.returns))


def main():
    rng = np.random.default_rng(1)
    out = dict(observations=OBSERVATIONS, actions=ACTIONS, actor=ACTOR, critic=CRITIC,
               adam=dict(rate=RATE, epsilon=EPSILON, max_norm=MAX_NORM, steps=STEPS),
               cases=[make_case(name, o, rng) for name, o in CASES.items()], gae=make_gae(rng))
    print(json.dumps(out, separators=(",", ":")))


main()
