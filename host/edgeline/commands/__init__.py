"""The command `edgeline`: a module per command, `options` and `report` for what they share.

Results go to standard output, progress and errors to standard error, progress only if that is a terminal. Exit codes:
0 done, 1 `verify` found a difference, 2 a bad command line or file, 3 no device (port absent, busy or forbidden, or
nothing there that speaks this wire), 4 the stream failed (link lost, no verified frame in time, a damaged recording),
130 interrupted.
"""
