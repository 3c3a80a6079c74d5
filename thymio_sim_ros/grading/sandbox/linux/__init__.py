"""What Linux alone gives to isolate and limit a submission: namespaces, Landlock, seccomp, /proc."""
