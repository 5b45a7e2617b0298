"""Studies of many runs. `sweep` runs a deck for several values of keys. `fit` fits values of keys to experiments, and
`outline` finds the outlines of particles in pictures. `phases` and `critical` find the borders between motions, and
critical values, by bisection. Each of these modules has a command with its name, for example tanktread-sweep."""
