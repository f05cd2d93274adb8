"""A game in which bodies are made of points, with methods that are there at once."""

from gambol.game.app.app import Play
from gambol.game.world.world import DT


def game(walker, **options):
    play = Play(walker, **options)
    for name in ("trackers", "ours"):
        play.held_points.methods(name, "6")
    return play


def ticks(play, count=1):
    for _ in range(count):
        play.tick(DT)
        play.scene((1280, 720))
