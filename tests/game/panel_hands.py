"""What hands do to panels: point, press, click and tap, and let the game see it."""

from gambol.game.hosts.events import KeyEvent, MouseMove

SIZE = (1280, 720)
NOWHERE = (640, 400)


def frames(game, count=2):
    for _ in range(count):
        game.tick(1 / 60)
        scene = game.scene(SIZE)
    return scene


def point(game, x, y):
    game.handle(MouseMove(x / SIZE[1], y / SIZE[1], 0.0, 0.0))
    frames(game)


def button(game, pressed):
    game.handle(KeyEvent("LEFT_BUTTON", pressed))
    frames(game)


def click(game, x, y):
    point(game, x, y)
    button(game, True)
    button(game, False)


def tap(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, True))
        game.handle(KeyEvent(key, False))
    return frames(game)
