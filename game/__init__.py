"""The theatre: it reads pads and scripts, keeps time, draws and records what the controllers do.

`world` is what is simulated, `scene` what a frame shows, `play` the game and `film` a scenario as
they run, `hosts` the window and the offscreen picture that show either. Importing any of it opens
no window and touches no GL.
"""
