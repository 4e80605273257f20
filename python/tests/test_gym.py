"""The Gymnasium environments are proper ones, and their episodes are flight logs."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import tiltrotor
import tiltrotor.gym

TASKS = list(tiltrotor.gym.TASKS)


def _id(task: str) -> str:
    return f"tiltrotor/{task.capitalize()}-v0"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("task", TASKS)
def test_gymnasium_finds_nothing_wrong(task):
    check_env(gymnasium.make(_id(task)).unwrapped)


@pytest.mark.parametrize("task", TASKS)
def test_an_episode_is_a_log_that_reflies(tmp_path, task):
    env = gymnasium.make(_id(task), record=tmp_path)
    _, info = env.reset(seed=7)
    env.action_space.seed(7)
    for _ in range(25):
        *_, ended, cut, info = env.step(0.1 * env.action_space.sample())
        if ended or cut:
            break
    env.reset(seed=8)
    env.close()
    verdict = tiltrotor.verify(info["log"])
    assert verdict and verdict.last_tick >= 10
    assert len(list(tmp_path.glob("*.mcap"))) == 2


def test_no_log_takes_the_place_of_another(tmp_path):
    """A second run, or a second environment with the same folder, goes on with the numbers."""
    envs = [gymnasium.make(_id("hover"), record=tmp_path) for _ in range(2)]
    logs = []
    for env in (*envs, gymnasium.make(_id("hover"), record=tmp_path)):
        for _ in range(2):
            _, info = env.reset(seed=1)
            env.step(np.zeros(5, np.float32))
            logs.append(info["log"])
    for env in envs:
        env.close()
    assert len(set(logs)) == len(list(tmp_path.iterdir())) == 6
    assert all(tiltrotor.verify(log) for log in logs[:4])


def _sums(task: str, seed: int) -> list[float]:
    env = gymnasium.make(_id(task))
    observation, _ = env.reset(seed=seed)
    rewards = [float(observation.sum())]
    for _ in range(20):
        observation, reward, *_ = env.step(np.zeros(5, np.float32))
        rewards += [float(observation.sum()), float(reward)]
    return rewards


def test_the_same_seed_is_the_same_episode():
    assert _sums("hover", 3) == _sums("hover", 3)
    assert _sums("hover", 3) != _sums("hover", 4)


def test_conversion_is_done_by_the_nacelle_switch_and_a_hand_on_the_height():
    """A simple hand: nacelles forward, height held by the stick, speed left to the lever."""
    env = gymnasium.make(_id("conversion"))
    seen, _ = env.reset(seed=0)
    total, info = 0.0, {}
    for _ in range(1500):
        height, sink, pitch_rate = seen[2] * 50.0, seen[6] * 10.0, seen[11]
        aft = np.clip(-0.004 * height + 0.02 * sink - 0.5 * pitch_rate, -0.3, 0.3)
        seen, reward, ended, cut, info = env.step(np.array([aft, 0, 0, 0.4, 1.0], np.float32))
        total += float(reward)
        if ended or cut:
            break
    assert info["done"], (total, seen)
    assert total > 20.0


def test_landing_is_done_by_lowering_the_lever():
    """Straight down, slowly, held level by the SCAS and a little stick."""
    env = gymnasium.make(_id("landing"))
    seen, _ = env.reset(seed=2)
    info: dict[str, object] = {}
    lever = 0.0
    for _ in range(1500):
        sink_mps = seen[6] * 10.0
        lever = float(np.clip(lever + 0.02 * (sink_mps - 0.8), -1.0, 1.0))
        forward, right = seen[4] * 50.0, seen[5] * 50.0
        north, east = seen[0] * 50.0, seen[1] * 50.0
        # The nose points west: north is to the right, west ahead.
        ahead, aside = -east, north
        aft = np.clip(0.03 * forward + 0.01 * ahead - 0.8 * seen[11] - 0.6 * seen[8], -0.4, 0.4)
        roll = np.clip(-0.03 * right - 0.01 * aside - 0.3 * seen[10] - 0.3 * seen[7], -0.4, 0.4)
        pedal = np.clip(-1.0 * seen[9] - 0.5 * seen[12], -0.4, 0.4)
        action = np.array([aft, roll, pedal, lever, 0.0], np.float32)
        seen, _, ended, cut, info = env.step(action)
        if ended or cut:
            break
    assert info["done"], seen
