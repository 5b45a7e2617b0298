"""Studies of many runs: `sweep` over values of keys, `fit` to experiments with `outline` of pictures, `phases` and
`critical` by bisection. Each module has a command: tanktread-sweep and so on."""
