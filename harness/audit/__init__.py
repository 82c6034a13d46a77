"""The paper's statements as executable checks, each with a verdict and its smallest example.

* ``registry.CLAIMS``: the claims, each with the reading that is tested, what counts as a failure,
  which arithmetic decides and what a finite experiment shows;
* ``runner.run_audit``: tries them over many instances and stores rows, verdicts and examples;
* ``shrink.shrink``: makes an example small.
"""
